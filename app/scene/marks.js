// Edge, scene: marks what our style sheet tells by its contents. `:has()` would say the same, but then a browser
// looks at two thirds of the page again at every word that changes in the panel, while it should draw the shoe.
(() => {
  const resets = new Set(RESETS);
  const mark = (element, name, value = "") => element && element.setAttribute(`data-ss-${name}`, value);
  const all = (root, what) => [...(root.matches(what) ? [root] : []), ...root.querySelectorAll(what)];
  const look = (root) => {
    for (const label of all(root, ".mantine-Text-root > label"))
      mark(label.parentElement.parentElement, "named", label.firstChild ? "yes" : "no");
    for (const plot of all(root, ".uplot-container")) {
      mark(plot.parentElement && plot.parentElement.parentElement, "graphs");
      mark(plot.closest("[data-floating-window]"), "graph-window");
    }
    for (const button of all(root, "[id]"))
      if (resets.has(button.id)) {
        mark(button.parentElement, "reset");
        mark(button.parentElement.previousElementSibling, "resettable");
      }
  };
  new MutationObserver((changes) => {
    for (const element of new Set(changes.map((change) => change.target)))
      if (element instanceof Element && element.isConnected) look(element);
  }).observe(document, { childList: true, subtree: true });
})();
