// Edge, scene: keys, and a window without focus that still comes back after the server restarts.
(() => {
  const presses = KEY_PRESSES;
  const typing = (target) =>
    target instanceof HTMLElement &&
    (target.isContentEditable || /^(input|textarea|select)$/i.test(target.tagName)) &&
    !/^(checkbox|radio|range|button)$/i.test(target.type || "");
  const fullScreen = () =>
    document.fullscreenElement ? document.exitFullscreen() : document.documentElement.requestFullscreen();
  window.addEventListener("keydown", (event) => {
    if (event.repeat || event.ctrlKey || event.metaKey || event.altKey || typing(event.target)) return;
    const key = event.key.toLowerCase();
    if (key === "f") fullScreen().catch(() => {});
    const viewer = window.__viserMutable;
    if (key === " ") {
      event.preventDefault(); // no scrolling, and no second press of the button that has the focus
      if (document.activeElement instanceof HTMLElement) document.activeElement.blur();
    }
    const watching = document.documentElement.dataset.visitor === "viewer";
    if (presses[key] && !watching && viewer && viewer.sendMessage) viewer.sendMessage(presses[key]);
  });
  // viser retries a lost connection only while the document has the focus; a wall display has none.
  document.hasFocus = () => document.visibilityState === "visible";
})();
