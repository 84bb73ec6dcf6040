/**
 * Runs inside the page that is measured: reads the bar code (see pattern.py) off what is drawn, after every
 * animation frame, and notes when a new one appears. Times are performance.now() [ms].
 */
(() => {
  const CELLS = 16;
  const CODE_BITS = 9;
  const cells = document.createElement("canvas");
  cells.width = CELLS;
  cells.height = 1;
  const reader = cells.getContext("2d", { willReadFrequently: true });
  reader.imageSmoothingEnabled = false;

  const probe = {
    source: null,
    aspect: 1,
    isRunning: false,
    samples: [],
    unreadable: 0,

    /** Where the picture lies inside the source: letterboxed in a canvas, all of an <img>. */
    area() {
      const { source, aspect } = this;
      const width = source.naturalWidth ?? source.width;
      const height = source.naturalHeight ?? source.height;
      const shown = Math.min(width, height * aspect);
      return { left: (width - shown) / 2, top: (height - shown / aspect) / 2, width: shown, height: shown / aspect };
    },

    /** The code on the picture now, or null. */
    read() {
      const { left, top, width, height } = this.area();
      if (!(width > CELLS)) return null;
      reader.drawImage(this.source, left, top + height / 32, width, 1, 0, 0, CELLS, 1);
      const { data } = reader.getImageData(0, 0, CELLS, 1);
      const bits = Array.from({ length: CELLS }, (_, i) => Number(data[4 * i] + data[4 * i + 1] + data[4 * i + 2] > 384));
      const code = bits.slice(2, 2 + CODE_BITS);
      const zeros = code.filter((bit) => !bit).length % 8;
      const ends = [...bits.slice(0, 2), ...bits.slice(-5)].join("");
      if (ends !== `10${zeros.toString(2).padStart(3, "0")}01`) return null;
      return parseInt(code.join(""), 2);
    },

    /** Begin to sample; `selector` names a <canvas> or an <img>. */
    start(selector, aspect) {
      this.source = document.querySelector(selector);
      this.aspect = aspect;
      this.samples = [];
      this.unreadable = 0;
      this.isRunning = true;
      let last = null;
      const { port1, port2 } = new MessageChannel();
      // A message comes after all animation callbacks of this frame: the page's own drawing is done by then.
      port1.onmessage = () => {
        const code = this.read();
        if (code === null) this.unreadable += 1;
        else if (code !== last) this.samples.push([code, performance.now()]);
        last = code ?? last;
      };
      const tick = () => {
        if (!this.isRunning) return;
        port2.postMessage(null);
        requestAnimationFrame(tick);
      };
      requestAnimationFrame(tick);
    },

    /** End and hand over what was seen. */
    stop() {
      this.isRunning = false;
      return { samples: this.samples, unreadable: this.unreadable };
    },

    /** Compare clocks: returns [sent, received, told] of `count` exchanges with the bench's clock socket. */
    compareClocks(url, count) {
      return new Promise((resolve, reject) => {
        const socket = new WebSocket(url);
        const rounds = [];
        let sent = 0;
        const ask = () => {
          sent = performance.now();
          socket.send("");
        };
        socket.onopen = ask;
        socket.onerror = () => reject(new Error("no clock socket"));
        socket.onmessage = ({ data }) => {
          rounds.push([sent, performance.now(), data]);
          if (rounds.length < count) setTimeout(ask, 2);
          else {
            socket.close();
            resolve(rounds);
          }
        };
      });
    },
  };
  window.tapreachProbe = probe;
})();
