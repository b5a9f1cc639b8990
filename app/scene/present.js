// Edge, scene: keeps the page on the present: says how old it is when nothing comes, connects anew after a sleep.
(() => {
  const TICK_MS = 250, STALE_MS = 2200, SLEPT_MS = 3000, SILENT_TICKS = 40, AGAIN_TICKS = 240;
  let link = null; // viser's worker, which holds the websocket
  let offset = Infinity; // the smallest difference of the two clocks since the connection began
  let shown = "", sign = null;
  let silent = 0; // ticks in which nothing came; a page that is busy drawing ticks as slowly as it hears
  let patience = SILENT_TICKS; // longer when a new connection brought no beat: the program itself stands still

  const post = Worker.prototype.postMessage;
  Worker.prototype.postMessage = function (message, ...rest) {
    if (message && message.type === "set_server" && link !== this) {
      link = this;
      link.addEventListener("message", ({ data }) => {
        silent = 0;
        if (data.type === "connected") offset = Infinity;
      });
    }
    return post.call(this, message, ...rest);
  };
  // The worker throws away what still comes by its old socket: nobody sees the past go by.
  const connectAnew = () => {
    silent = 0;
    if (link) post.call(link, { type: "retry" });
  };

  const age = () => {
    const beat = document.querySelector("[data-ss-beat]");
    if (!beat) return 0;
    const difference = Date.now() - 1000 * Number(beat.dataset.ssBeat);
    if (beat.dataset.ssBeat !== shown) {
      shown = beat.dataset.ssBeat;
      patience = SILENT_TICKS;
      offset = Math.min(offset, difference);
    }
    return difference - offset;
  };
  const say = (ms) => {
    if (!sign && ms && document.body) {
      sign = document.createElement("div");
      sign.id = "ss-cut-off";
      sign.className = "ss-stale";
      sign.setAttribute("role", "status");
      document.body.append(sign);
    }
    if (!sign) return;
    sign.hidden = !ms;
    if (ms) sign.textContent = `STALE ${Math.round(ms / 1000)} s: nothing comes from the program`;
  };
  const look = () => {
    const ms = age();
    say(ms > STALE_MS ? ms : 0);
    return ms;
  };
  const back = () => {
    if (look() > STALE_MS) connectAnew();
  };

  setInterval(() => {
    if (document.hidden) return;
    look();
    if (shown) silent += 1; // a page without a beat is not waited for
    if (silent >= patience) {
      patience = AGAIN_TICKS;
      connectAnew();
    }
  }, TICK_MS);
  // A thread with nothing to do tells a sleep from a page that is busy drawing.
  const watch = `let last = Date.now(); setInterval(() => {
    const now = Date.now(); if (now - last > ${SLEPT_MS}) postMessage(0); last = now; }, ${TICK_MS});`;
  const watchman = new Worker(URL.createObjectURL(new Blob([watch], { type: "text/javascript" })));
  watchman.onmessage = () => document.hidden || back();
  document.addEventListener("visibilitychange", () => document.hidden || back());
  document.addEventListener("resume", back);
  window.addEventListener("pageshow", (event) => event.persisted && back());
})();
