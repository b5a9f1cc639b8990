// Edge, scene: a viewer's page says so, and its controls are still: the door lets nothing of theirs through.
(() => {
  if (document.documentElement.dataset.visitor !== "viewer") return;
  const CONTROL = "input, textarea, select, button, label, [role=slider], [role=combobox], .mantine-Slider-root";
  const FREE = "[role=tab], [role=alert], [data-testid=floating-panel-handle]"; // of the page itself
  const hold = (event) => {
    const target = event.target;
    if (!(target instanceof Element) || !target.closest(CONTROL) || target.closest(FREE)) return;
    event.preventDefault();
    event.stopImmediatePropagation();
    if (target instanceof HTMLElement) target.blur();
  };
  const kinds = ["pointerdown", "mousedown", "touchstart", "click", "dblclick", "beforeinput", "input", "change", "paste", "drop"];
  for (const kind of kinds) window.addEventListener(kind, hold, { capture: true, passive: false });
  window.addEventListener("keydown", (event) => event.key === "Tab" || hold(event), { capture: true });
  const asked = new URLSearchParams(location.search);
  if (asked.has("tile") || asked.has("kiosk")) return; // a wall shows the picture and nothing else
  document.addEventListener("DOMContentLoaded", () => {
    const sign = document.createElement("div");
    sign.id = "ss-watching";
    sign.textContent = "Watching only";
    sign.title = "This address shows everything and moves nothing; the operator has another one.";
    document.body.append(sign);
  });
})();
