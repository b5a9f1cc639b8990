// Edge, scene: while the town is on its way, its sky and a row of roofs, what is being waited for, and how far it is.
// On a wall it is one picture over all tiles, as the town will be.
(() => {
  const HOUSES = [14, 21, 17, 26, 19, 31, 23, 16, 28, 20, 24, 15, 22, 18]; // heights, in hundredths of the picture
  const STEPS = [
    ["The page is starting", 0.08],
    ["Waiting for the program to answer", 0.25],
    ["The town is on its way", 0.45],
    ["The town is being drawn", 0.85],
    ["Here it is", 1],
  ];
  const PICTURES = 3; // drawn before the curtain rises: colours and sky are put right in the first
  const make = (parent, name) => {
    const element = document.createElement("div");
    element.className = name;
    parent.append(element);
    return element;
  };
  const root = make(document.documentElement, "mover-loading"), picture = make(root, "ml-picture");
  const roofs = make(picture, "ml-roofs"), box = make(picture, "ml-box");
  for (const height of HOUSES) make(roofs, "ml-house").style.height = `${height}%`;
  make(box, "ml-name").textContent = "Stridescope";
  const words = make(box, "ml-words"), bar = make(make(box, "ml-bar"), "ml-done");
  root.setAttribute("role", "status");

  const finished = (name) => {
    let all = 0, done = 0;
    window.__viserMutable?.nodeRefFromName?.[name]?.traverse((thing) => {
      if (!thing.material) return;
      all += 1;
      done += thing.material.userData.mover ? 1 : 0;
    });
    return all === 0 ? 0 : all === done ? 2 : 1; // not there, there, as it is to be seen
  };
  function step() {
    if (!window.__viserMutable) return 0;
    if (!document.getElementById("mover-data")) return 1;
    const least = Math.min(finished("/world/town"), finished("/world/sky"));
    return 2 + least;
  }
  let drawn = 0, shown = -1;
  function look() {
    const { W, H, x, y } = mover.frame();
    picture.style.cssText = `left:${-x}px;top:${-y}px;width:${W}px;height:${H}px;--unit:${Math.min(H, 0.75 * W) / 100}px`;
    const now = step();
    if (now !== shown) {
      shown = now;
      words.textContent = STEPS[now][0];
      bar.style.width = `${100 * STEPS[now][1]}%`;
    }
    drawn = now === STEPS.length - 1 ? drawn + 1 : 0;
    if (drawn <= PICTURES) return requestAnimationFrame(look);
    root.classList.add("ml-over");
    setTimeout(() => root.remove(), 600);
  }
  look();
})();
