// Edge, scene: the town mode's camera: held still, wide as the window or the wall it is a tile of; its keys.
const mover = MOVER_TOLD;
(() => {
  const asked = new URLSearchParams(location.search);
  const [columns, rows] = mover.wall;
  mover.tile = tileOf(asked.get("tile"));
  mover.bare = mover.tile !== null || asked.has("kiosk") || (mover.kiosk && !asked.has("operator"));
  if (mover.bare) document.documentElement.classList.add("mover-bare");
  if (mover.tile) document.documentElement.classList.add("mover-tile");

  function tileOf(text) {
    if (text === null) return null;
    const names = { left: 0, centre: Math.floor((columns - 1) / 2), center: Math.floor((columns - 1) / 2), right: columns - 1 };
    const [column, row] = text in names ? [names[text], 0] : text.split(",").map(Number);
    const fits = Number.isInteger(column) && column >= 0 && column < columns && Number.isInteger(row ?? 0) && (row ?? 0) >= 0 && (row ?? 0) < rows;
    return fits ? { column, row: row ?? 0, columns, rows } : null;
  }

  // The whole picture in pixels, and where this window lies in it.
  mover.frame = () => {
    const canvas = viewer()?.canvas, t = mover.tile;
    if (t) {
      const w = innerWidth, h = innerHeight;
      return { left: 0, top: 0, w, h, W: w * t.columns, H: h * t.rows, x: w * t.column, y: h * t.row };
    }
    const box = canvas ? canvas.getBoundingClientRect() : { left: 0, top: 0, width: innerWidth, height: innerHeight };
    const w = Math.round(box.width), h = Math.round(box.height);
    return { left: box.left, top: box.top, w, h, W: w, H: h, x: 0, y: 0 };
  };
  const viewer = () => window.__viserMutable;

  // A tile draws the whole picture and shows its own part of it: every pixel is the one that a single window
  // would have. A frustum of its own would round the corners of triangles otherwise.
  function spread(f) {
    const frame = viewer()?.canvas?.parentElement?.parentElement;
    if (!mover.tile || !frame) return;
    const style = `position:fixed;left:${-f.x}px;top:${-f.y}px;width:${f.W}px;height:${f.H}px;overflow:hidden`;
    if (frame.dataset.mover === style) return;
    frame.dataset.mover = style;
    frame.style.cssText = style;
  }

  function hold() {
    const v = viewer(), camera = v?.camera;
    if (!camera) return;
    const f = mover.frame();
    if (!f.w || !f.h) return;
    spread(f);
    const aspect = f.W / f.H, most = (2 * Math.atan(Math.tan((52 * Math.PI) / 180) / aspect) * 180) / Math.PI;
    const fov = Math.min(mover.fov, most);
    if (camera.manual && camera.fov === fov && camera.aspect === aspect) return;
    camera.manual = true;
    camera.fov = fov;
    camera.aspect = aspect;
    camera.updateProjectionMatrix();
    v.requestRender?.();
  }

  // Colours are shown as they are; the sky lies behind all fog.
  function finish() {
    const nodes = viewer()?.nodeRefFromName;
    for (const name of ["/world/town", "/world/sky", "/world/goal"]) {
      nodes?.[name]?.traverse((thing) => {
        const material = thing.material;
        if (!material || material.userData.mover) return;
        material.userData.mover = true;
        material.toneMapped = false;
        if (name === "/world/sky") {
          material.fog = material.depthWrite = false;
          thing.renderOrder = -1;
          thing.frustumCulled = false;
        }
        if (name === "/world/goal") {
          material.depthWrite = false;
          material.fog = false;
        }
        if (material.map) {
          material.map.anisotropy = 8;
          material.map.needsUpdate = true;
        }
        material.needsUpdate = true;
        viewer().requestRender?.();
      });
    }
  }
  function again() {
    hold();
    requestAnimationFrame(again);
  }
  requestAnimationFrame(again);
  setInterval(finish, 250);

  // --- keys ---
  const typing = (target) =>
    target instanceof HTMLElement &&
    (target.isContentEditable || /^(input|textarea|select)$/i.test(target.tagName)) &&
    !/^(checkbox|radio|range|button)$/i.test(target.type || "");
  const arrows = { ArrowUp: "f", ArrowDown: "b", ArrowLeft: "l", ArrowRight: "r" };
  const held = new Set();
  let number = 0, said = "";
  const send = (message) => viewer()?.sendMessage?.(message);
  function steer() {
    const keys = [...held].join("");
    if (keys === "" && said === "") return;
    said = keys;
    send({ type: "GuiUpdateMessage", uuid: mover.keys, updates: { value: `${keys} ${number++ % 1000}` } });
  }
  setInterval(() => held.size && steer(), 100); // the server lets go of keys that it does not hear of
  const letGo = () => {
    held.clear();
    steer();
  };
  window.addEventListener("blur", letGo);
  let leaving = false; // full screen by F; by Esc the page hears of no key, and it is to stop all the same
  document.addEventListener("fullscreenchange", () => {
    if (document.fullscreenElement) return;
    if (!leaving && mover.presses.escape) send(mover.presses.escape);
    leaving = false;
  });
  window.addEventListener("keydown", (event) => {
    const stop = event.key === "Escape"; // wherever the hand is
    if (!stop && (typing(event.target) || event.ctrlKey || event.metaKey || event.altKey)) return;
    if (/^(Arrow|[wasdqeWASDQE]$)/.test(event.key)) event.stopImmediatePropagation(); // viser's own camera keys
    if (arrows[event.key]) {
      event.preventDefault();
      held.add(arrows[event.key]);
      if (event.shiftKey) held.add("s");
      if (!event.repeat) steer();
      return;
    }
    if (event.repeat) return;
    const key = event.key.toLowerCase();
    if (key === "f") {
      leaving = Boolean(document.fullscreenElement);
      const full = document.fullscreenElement ? document.exitFullscreen() : document.documentElement.requestFullscreen();
      full.catch(() => {});
    }
    if (key === "h") document.documentElement.classList.toggle("mover-quiet");
    if (key === " ") {
      event.preventDefault();
      if (document.activeElement instanceof HTMLElement) document.activeElement.blur();
    }
    if (mover.presses[key]) send(mover.presses[key]);
  }, true);
  window.addEventListener("keyup", (event) => {
    if (event.key === "Shift") held.delete("s");
    if (!arrows[event.key]) return;
    event.stopImmediatePropagation();
    held.delete(arrows[event.key]);
    if (![...held].some((key) => key !== "s")) held.clear();
    steer();
  }, true);

  // Nobody turns the camera with the mouse: a click on the town only takes the hand off the panel.
  for (const kind of ["pointerdown", "mousedown", "touchstart", "wheel", "dblclick", "contextmenu"]) {
    window.addEventListener(kind, (event) => {
      if (!(event.target instanceof HTMLCanvasElement) || !event.target.dataset.engine) return;
      event.stopImmediatePropagation();
      if (kind === "wheel" || kind === "contextmenu") event.preventDefault();
      if (document.activeElement instanceof HTMLElement) document.activeElement.blur();
    }, { capture: true, passive: false });
  }
  // viser retries a lost connection only while the document has the focus; a wall has none.
  document.hasFocus = () => true;
})();
