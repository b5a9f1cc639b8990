// Edge, scene: what is drawn over the town: feet, map, score, words. State comes as JSON and is set as text only.
(() => {
  const NS = "http://www.w3.org/2000/svg";
  const make = (parent, kind, name, text) => {
    const element = document.createElement(kind);
    element.className = name;
    if (text) element.textContent = text;
    parent.append(element);
    return element;
  };
  const draw = (parent, kind, attributes) => {
    const element = document.createElementNS(NS, kind);
    for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
    parent.append(element);
    return element;
  };
  const SOLE = "M30 4c13 0 19 13 18 29-1 14-6 22-6 34 0 10 4 16 3 25-1 8-7 12-15 12s-15-4-16-13c-1-8 3-14 3-24 0-13-6-20-6-34C11 16 17 4 30 4z";
  const SIGNS = { step: "▲", back: "▼", twist: "⟳", taps: "·", moves: "…", silent: "✕", missing: "✕", rubbish: "!", still: "" };
  const WORDS = { step: "step", back: "step back", twist: "twist", taps: "toe only", moves: "moves", silent: "silent", missing: "no sensor", rubbish: "faulty", still: "still" };

  let root, part, state = null, last = "";
  function build() {
    root = make(document.body, "div", "mover");
    const vignette = make(root, "div", "mv-vignette");
    const top = make(root, "div", "mv-top");
    const score = make(top, "div", "mv-score");
    const goal = make(top, "div", "mv-goal");
    const arrow = make(goal, "span", "mv-arrow", "▲");
    const metres = make(goal, "span", "mv-metres");
    const banner = make(root, "div", "mv-banner");
    const cheer = make(root, "div", "mv-cheer");
    const card = make(root, "div", "mv-card");
    const bottom = make(root, "div", "mv-bottom");
    const feet = ["left", "right"].map((side) => foot(bottom, side));
    const said = make(bottom, "div", "mv-said");
    bottom.insertBefore(said, feet[1].box);
    const motion = make(said, "div", "mv-motion"), reason = make(said, "div", "mv-reason");
    const map = make(root, "canvas", "mv-map");
    map.width = map.height = 420;
    part = { vignette, top, score, goal, arrow, metres, banner, cheer, card, bottom, feet, motion, reason, map, ground: ground() };
    part.count = make(card, "div", "mv-count");
    part.title = make(card, "div", "mv-title");
    part.words = make(card, "div", "mv-words");
    part.note = make(card, "div", "mv-note");
    part.bar = make(make(card, "div", "mv-bar"), "i", "");
  }
  function foot(parent, side) {
    const box = make(parent, "div", `mv-foot mv-${side}`);
    const svg = draw(box, "svg", { viewBox: "0 0 60 108" });
    const shape = draw(svg, "path", { d: SOLE });
    if (side === "left") shape.setAttribute("transform", "translate(60 0) scale(-1 1)");
    const sign = draw(svg, "text", { x: 30, y: 48, "text-anchor": "middle" });
    return { box, sign, word: make(box, "div", "mv-word") };
  }

  // --- the map: drawn once, then turned under the walker ---
  const SCALE = 3;
  function ground() {
    const { half, blocks, houses, landmark, trees } = mover.plan, picture = document.createElement("canvas");
    picture.width = picture.height = 2 * half * SCALE;
    const pen = picture.getContext("2d");
    const box = ([s, w, n, e], ink) => {
      pen.fillStyle = ink;
      pen.fillRect((w + half) * SCALE, (half - n) * SCALE, (e - w) * SCALE, (n - s) * SCALE);
    };
    box([-half, -half, half, half], "#7d838c");
    for (const block of blocks) box(block, "#d3cabb");
    for (const house of houses) box(house, "#a5714f");
    pen.fillStyle = "#5f8c48";
    for (const [n, e] of trees) {
      pen.beginPath();
      pen.arc((e + half) * SCALE, (half - n) * SCALE, 1.5 * SCALE, 0, 7);
      pen.fill();
    }
    box(landmark, "#2f5d50");
    return picture;
  }
  // Where the walker is, from the frame that moves: R = Rz(heading) · NED, t = −Rz(heading) p.
  function walker() {
    const world = window.__viserMutable?.nodeRefFromName?.["/world"];
    if (!world) return null;
    const { x, y, z, w } = world.quaternion, t = world.position;
    const heading = Math.atan2(-(1 - 2 * (y * y + z * z)), 2 * (x * y + w * z)), c = Math.cos(heading), s = Math.sin(heading);
    return { heading, east: -(c * t.x + s * t.y), north: -(-s * t.x + c * t.y) };
  }
  function drawMap(at) {
    const pen = part.map.getContext("2d"), size = 420, zoom = 2.1, r = size / 2;
    const half = mover.plan.half;
    pen.save();
    pen.clearRect(0, 0, size, size);
    pen.beginPath();
    pen.arc(r, r, r - 4, 0, 7);
    pen.clip();
    pen.fillStyle = "#86a35c";
    pen.fillRect(0, 0, size, size);
    pen.translate(r, r);
    pen.rotate(-at.heading);
    pen.scale(zoom, zoom);
    pen.translate(-at.east, at.north);
    pen.drawImage(part.ground, -half, -half, 2 * half, 2 * half);
    pen.restore();
    if (state?.goal) {
      const dn = state.goal.north - at.north, de = state.goal.east - at.east;
      const bearing = Math.atan2(de, dn) - at.heading, away = Math.min(Math.hypot(dn, de) * zoom, r - 24);
      const x = r + away * Math.sin(bearing), y = r - away * Math.cos(bearing);
      pen.fillStyle = "#ffb81f";
      pen.strokeStyle = "#3a2a00";
      pen.lineWidth = 3;
      pen.beginPath();
      pen.arc(x, y, 12, 0, 7);
      pen.fill();
      pen.stroke();
      part.arrow.style.transform = `rotate(${bearing}rad)`;
    }
    pen.fillStyle = "#fff";
    pen.strokeStyle = "#16202c";
    pen.lineWidth = 4;
    pen.beginPath();
    pen.moveTo(r, r - 17);
    pen.lineTo(r + 12, r + 13);
    pen.lineTo(r, r + 7);
    pen.lineTo(r - 12, r + 13);
    pen.closePath();
    pen.stroke();
    pen.fill();
  }

  const clock = (seconds) => `${Math.floor(seconds / 60)}:${String(seconds % 60).padStart(2, "0")}`;
  const show = (element, on) => element.classList.toggle("mv-on", Boolean(on));
  function tell() {
    const s = state, done = s.targets > 0 && s.score >= s.targets;
    const best = s.best === null ? "" : `  ·  best ${clock(s.best)}`;
    part.score.textContent = `${s.score} of ${s.targets} found  ·  ${clock(s.seconds)}${best}`;
    show(part.goal, s.goal);
    part.metres.textContent = s.goal ? `${s.goal.metres} m` : "";
    const banner = s.halted ? "Stopped: the operator goes on with Space or Go on" : s.fault || s.message || (s.idle !== null ? `Next visitor in ${s.idle} s` : "");
    part.banner.textContent = banner;
    part.banner.classList.toggle("mv-bad", Boolean(s.halted || s.fault));
    show(part.banner, banner);
    part.cheer.textContent = done ? `All ${s.targets} found in ${clock(s.seconds)}` : `Found: ${s.score} of ${s.targets}`;
    show(part.cheer, s.reached);
    part.feet.forEach((foot, i) => {
      const { state: word, size } = s.feet[i], live = !["still", "silent", "missing"].includes(word);
      foot.sign.textContent = SIGNS[word] ?? "";
      foot.word.textContent = WORDS[word] ?? word;
      foot.box.classList.toggle("mv-live", live);
      foot.box.classList.toggle("mv-broken", ["silent", "missing", "rubbish"].includes(word));
      foot.box.style.setProperty("--size", live ? 0.45 + 0.55 * size : 0);
    });
    part.motion.textContent = s.halted ? "stopped" : s.touching && s.moving ? `${s.motion} (a wall)` : s.motion;
    part.reason.textContent = s.fault || s.reason;
    show(part.card, s.task);
    if (s.task) {
      part.count.textContent = `Set-up, ${s.task.number} of ${s.task.of}`;
      part.title.textContent = s.task.title;
      part.words.textContent = s.task.words;
      part.note.textContent = s.task.note;
      part.bar.style.width = `${100 * s.task.part}%`;
    }
    part.map.style.display = s.map ? "" : "none";
    part.vignette.style.opacity = s.vignette ? Math.min(1, s.speed / 1.2 + Math.abs(s.turn) / 0.8) : 0;
  }

  // An operator's words stand where no panel lies: beside, above or below each, wherever more is left.
  const PANELS = '[data-floating-window], .mantine-Paper-root[style*="max-height: 60%"]';
  const GAP_PX = 10, LEAST_UNIT_PX = 5.6, WIDE_UNITS = 74;
  const size = ([left, top, right, bottom]) => Math.max(0, right - left) * Math.max(0, bottom - top);
  function free(area) {
    for (const panel of document.querySelectorAll(PANELS)) {
      const p = panel.getBoundingClientRect(), [left, top, right, bottom] = area;
      if (!p.width || p.left >= right || p.right <= left || p.top >= bottom || p.bottom <= top) continue;
      const around = [
        [left, top, Math.min(right, p.left - GAP_PX), bottom], [Math.max(left, p.right + GAP_PX), top, right, bottom],
        [left, top, right, Math.min(bottom, p.top - GAP_PX)], [left, Math.max(top, p.bottom + GAP_PX), right, bottom],
      ];
      area = around.reduce((best, other) => (size(other) > size(best) ? other : best));
    }
    return area;
  }
  let placed = "";
  function place() {
    const f = mover.frame(), bare = document.documentElement.classList.contains("mover-bare");
    const whole = [f.left - f.x, f.top - f.y, f.left - f.x + f.W, f.top - f.y + f.H];
    const [left, top, right, bottom] = bare ? whole : free(whole);
    const width = right - left, height = bottom - top;
    const unit = Math.max(Math.min(height, 0.75 * width) / 100, bare ? 0 : Math.min(LEAST_UNIT_PX, width / WIDE_UNITS));
    const where = `left:${left}px;top:${top}px;width:${width}px;height:${height}px;--unit:${unit}px`;
    if (where !== placed) root.style.cssText = placed = where;
  }
  // Thirty times a second at most, and only when something has moved: it costs as much as a house.
  const MAP_MS = 30;
  let mapped = "", mappedMs = 0;
  function showMap() {
    const at = walker(), nowMs = performance.now();
    if (!at || !state?.map || nowMs - mappedMs < MAP_MS) return;
    const what = JSON.stringify([at, state.goal]);
    if (what === mapped) return;
    [mapped, mappedMs] = [what, nowMs];
    drawMap(at);
  }
  function again() {
    requestAnimationFrame(again);
    if (!document.body) return;
    if (!root) build();
    place();
    const text = document.getElementById("mover-data")?.dataset.state;
    if (text && text !== last) {
      last = text;
      state = JSON.parse(text);
      root.classList.add("mv-ready");
      tell();
    }
    showMap();
  }
  requestAnimationFrame(again);
})();
