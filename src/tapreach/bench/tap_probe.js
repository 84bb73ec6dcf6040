/**
 * Runs inside the operator page: notes every tap that the page sends to its control worker, together with the
 * bar code that was on the canvas when the finger came down. Needs browser_probe.js.
 */
(() => {
  const taps = {
    canvas: null,
    codeAtDown: null,
    /** [frame id the page sent, bar code that was painted] */
    pairs: [],

    /** Begin to note. */
    watch(selector, aspect) {
      this.canvas = document.querySelector(selector);
      tapreachProbe.source = this.canvas;
      tapreachProbe.aspect = aspect;
      // Capturing on window: before the page itself hears of the finger.
      window.addEventListener("pointerdown", () => (this.codeAtDown = tapreachProbe.read()), true);
    },

    /** Taps at random places and moments, `count` of them, by events of the page's own making. */
    async tapMany(count, seed) {
      const random = generator(seed);
      const { left, top, width, height } = tapreachProbe.area();
      const box = this.canvas.getBoundingClientRect();
      const ratio = box.width / this.canvas.width;
      for (let i = 0; i < count; i += 1) {
        const clientX = box.left + ratio * (left + width * (0.05 + 0.9 * random()));
        const clientY = box.top + ratio * (top + height * (0.05 + 0.9 * random()));
        for (const type of ["pointerdown", "pointerup"]) {
          const init = { clientX, clientY, pointerId: 1, isPrimary: true, bubbles: true, cancelable: true };
          this.canvas.dispatchEvent(new PointerEvent(type, init));
        }
        await pause(5 * random());
      }
      return this.pairs;
    },
  };

  const post = Worker.prototype.postMessage;
  Worker.prototype.postMessage = function (data, ...rest) {
    const { message, ticket } = data ?? {};
    if (message?.type !== "tap") return post.call(this, data, ...rest);
    taps.pairs.push([message.frame_id, taps.codeAtDown]);
    // Not forwarded: the page learns, as on a choked link, that it was not sent.
    this.onmessage?.(new MessageEvent("message", { data: { kind: "unsent", ticket } }));
  };

  const pause = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

  /** Small repeatable random numbers (mulberry32). */
  const generator = (seed) => () => {
    seed = (seed + 0x6d2b79f5) | 0;
    let t = Math.imul(seed ^ (seed >>> 15), 1 | seed);
    t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
    return ((t ^ (t >>> 14)) >>> 0) / 4294967296;
  };

  window.tapreachTaps = taps;
})();
