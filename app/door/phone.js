// Edge, door: a phone's motion as messages (docs/message.md), sent again until they are acknowledged.
"use strict";

const RADIANS = Math.PI / 180, GRAVITY = 9.80665;
const STILL_READINGS = 30;      // half a second: by these the sign of the force is told
const MOST_KEPT = 36000;        // ten minutes at 60 a second
const MOST_IN_ONE = 100;
const MOST_SET_MS = 1000;       // by less the clock on the wall was set, not the phone asleep
// Toe, right and down as axes of the phone: 1 x (right edge), 2 y (top edge), 3 z (out of the screen); minus: the other way.
const SEATS = {toe: [2, 1, -3], heel: [-2, -1, -3], "left side": [2, -3, -1], "right side": [2, 3, 1]};

const byId = id => document.getElementById(id);
const chosen = name => document.querySelector(`input[name="${name}"]:checked`).value;
const turn = (v, seat) => SEATS[seat].map(axis => Math.sign(axis) * v[Math.abs(axis) - 1]);
const size = v => Math.hypot(...v);

let run = null;                 // what belongs to one start
let lock = null;

function show(kind, text) {
  byId("state").dataset.kind = kind;
  byId("state").textContent = text;
}

function problem() {
  if (!window.isSecureContext) {
    return "A phone gives its motion only to https pages. Start Stridescope with --tls-made and open its https address.";
  }
  return "DeviceMotionEvent" in window ? "" : "This browser tells no motion. Take Safari, Chrome or Firefox on a phone.";
}

// --- the sensor ---

async function allowed() {
  if (typeof DeviceMotionEvent.requestPermission !== "function") return true;
  try {
    return (await DeviceMotionEvent.requestPermission()) === "granted";
  } catch (error) {
    return false;
  }
}

function reading(event) {
  const a = event.accelerationIncludingGravity, r = event.rotationRate;
  if (!a || !r || [a.x, a.y, a.z, r.alpha, r.beta, r.gamma].some(n => typeof n !== "number" || !isFinite(n))) return null;
  // alpha, beta, gamma are about x, y, z
  return {f: [a.x, a.y, a.z], w: [r.alpha, r.beta, r.gamma].map(n => n * RADIANS)};
}

// A locked phone may stop the clock of its events: what the clock on its wall went on meanwhile, ms.
function slept() {
  const behind = Date.now() - performance.now();
  if (behind - run.behind > MOST_SET_MS) run.slept += behind - run.behind;
  run.behind = behind;
  return run.slept;
}

function onMotion(event) {
  if (!run) return;
  const raw = reading(event);
  const stamp = Math.round((event.timeStamp + slept()) * 1e6);
  if (!raw) {
    if (!run.count) show("bad", "This phone has no accelerometer or no gyroscope that a page can read.");
    return;
  }
  if (stamp <= run.stamp) return;             // the same reading again
  run.stamp = stamp;
  run.count += 1;
  const f = turn(raw.f, run.seat), w = turn(raw.w, run.seat);
  if (!run.sign && !(run.sign = signOf(f, w))) return;
  run.force = f.map(n => run.sign * n);
  keep({t_ns: stamp, f: run.force, w});
}

// iOS negates forces, Android does not: a shoe that stands flat tells, since force then points up.
function signOf(f, w) {
  const still = size(w) < 0.3 && Math.abs(size(f) - GRAVITY) < 1;
  run.still = still ? [...run.still, f[2]] : [];
  if (run.still.length < STILL_READINGS) {
    if (!run.misfit) show("", "Stand still, with the foot flat on the floor…");
    return 0;
  }
  const down = run.still.reduce((sum, n) => sum + n, 0) / run.still.length;
  run.still = [];
  run.misfit = Math.abs(down) < 0.8 * GRAVITY;
  if (run.misfit) {
    show("bad", "The phone does not sit as chosen: standing, another of its axes points up. Choose again, or move it.");
    return 0;
  }
  return down < 0 ? 1 : -1;
}

// --- the link ---

function keep(sample) {
  run.kept.push(sample);
  if (run.kept.length > MOST_KEPT) {
    run.kept.shift();
    run.first += 1;
    run.sent = Math.max(run.sent, run.first);
  }
  flush();
}

function flush() {
  const link = run.link;
  if (!link || link.readyState !== WebSocket.OPEN || link.bufferedAmount > 100000) return;
  while (run.sent < run.first + run.kept.length) {
    const from = run.sent - run.first;
    const samples = run.kept.slice(from, from + MOST_IN_ONE);
    link.send(JSON.stringify({v: 1, session: run.session, sensor: run.sensor, seq: run.sent, samples}));
    run.sent += samples.length;
    run.flying.push(run.sent);
  }
}

function connect() {
  const mine = run;
  const scheme = location.protocol === "https:" ? "wss:" : "ws:";
  const link = mine.link = new WebSocket(`${scheme}//${location.host}/feed${location.search}`);
  link.onopen = () => {
    mine.wait = 200;
    mine.away = false;
    mine.flying = [];
    mine.sent = mine.first;     // what was not acknowledged goes again
    flush();
  };
  link.onmessage = message => answered(mine, JSON.parse(message.data));
  link.onclose = () => {
    if (run !== mine) return;
    mine.away = true;
    setTimeout(() => run === mine && connect(), mine.wait);
    mine.wait = Math.min(2 * mine.wait, 2000);
  };
}

function answered(mine, told) {
  const end = mine.flying.shift();
  mine.refusal = told.error || "";
  const done = told.ack ? told.ack.next : end;  // what was refused is not sent again
  if (done > mine.first) {
    mine.delivered += told.ack ? done - mine.first : 0;
    mine.kept.splice(0, done - mine.first);
    mine.first = done;
  }
}

// --- the page ---

async function keepAwake() {
  try {
    lock = await navigator.wakeLock.request("screen");
    byId("awake").textContent = "yes";
  } catch (error) {
    byId("awake").textContent = "no: set it not to lock";
  }
}

async function start() {
  if (!(await allowed())) {
    show("bad", "The phone was told not to give its motion. Allow it: reload this page and tap Start again; on an iPhone, clear the site's data in Settings, Safari first.");
    return;
  }
  const random = crypto.getRandomValues(new Uint32Array(2));
  run = {
    session: Array.from(random, n => n.toString(16).padStart(8, "0")).join(""), sensor: chosen("foot"), seat: chosen("seat"),
    stamp: -1, count: 0, still: [], misfit: false, sign: 0, force: null, kept: [], first: 0, sent: 0, flying: [],
    delivered: 0, refusal: "", away: false, wait: 200, link: null, since: performance.now(),
    slept: 0, behind: Date.now() - performance.now(),
  };
  show("", "Waiting for the first reading…");
  window.addEventListener("devicemotion", onMotion);
  connect();
  keepAwake();
  settle(true);
}

function stop() {
  window.removeEventListener("devicemotion", onMotion);
  const link = run.link;
  run = null;
  link.close();
  if (lock) lock.release();
  lock = null;
  byId("awake").textContent = "–";
  show("", "Stopped.");
  settle(false);
}

function settle(running) {
  byId("start").textContent = running ? "Stop" : "Start";
  for (const id of ["foot", "seat"]) byId(id).hidden = running;
}

let countBefore = 0;
setInterval(() => {
  if (!run) { countBefore = 0; return; }
  byId("rate").textContent = `${Math.max(run.count - countBefore, 0)}`;
  countBefore = run.count;
  byId("force").textContent = run.force ? run.force.map(n => n.toFixed(1).replace("-", "−")).join(", ") : "–";
  byId("delivered").textContent = run.delivered;
  byId("waiting").textContent = run.kept.length;
  if (!run.count && performance.now() - run.since > 2000) {
    show("bad", "No reading comes. On a computer there is no such sensor; on a phone, allow motion for this site.");
  } else if (run.refusal) {
    show("bad", `Stridescope refused: ${run.refusal}`);
  } else if (run.away) {
    show("bad", "Stridescope does not answer. Readings are kept and sent when it does.");
  } else if (run.sign) {
    show("good", `● Sending as ${run.sensor === "foot" ? "the foot" : `the ${run.sensor} foot`}. Walk.`);
  }
}, 1000);

document.addEventListener("visibilitychange", () => {
  if (run && document.visibilityState === "visible") keepAwake();
});
byId("start").addEventListener("click", () => (run ? stop() : start()));
const wrong = problem();
if (wrong) {
  show("bad", wrong);
  byId("start").disabled = true;
}
