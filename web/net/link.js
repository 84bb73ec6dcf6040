/**
 * One WebSocket that comes back by itself: waits 0.25, 0.5, 1, 2, then 4 s between tries.
 *
 * Events: "state" (detail {@link LinkState}), "data" (detail: string or ArrayBuffer).
 *
 * @typedef {"connecting" | "open" | "waiting" | "refused"} LinkStage
 * @typedef {{stage: LinkStage, retryMs: number}} LinkState
 */
const FIRST_WAIT_MS = 250;
const LONGEST_WAIT_MS = 4000;

export class Link extends EventTarget {
  /**
   * @param {string} url of the socket
   * @param {string} probeUrl a plain address that answers 401 or 403 when this page may not connect
   * @param {number} silenceMs a socket that brings nothing for so long is dead; 0: never
   */
  constructor(url, probeUrl, silenceMs) {
    super();
    this.url = url;
    this.probeUrl = probeUrl;
    this.silenceMs = silenceMs;
    this.waitMs = FIRST_WAIT_MS;
    /** @type {WebSocket | null} */
    this.socket = null;
    this.retryTimer = 0;
    this.silenceTimer = 0;
  }

  open() {
    clearTimeout(this.retryTimer);
    this.announce("connecting", 0);
    const socket = new WebSocket(this.url);
    socket.binaryType = "arraybuffer";
    socket.onopen = () => {
      this.waitMs = FIRST_WAIT_MS;
      this.announce("open", 0);
      this.watchSilence();
    };
    socket.onmessage = (event) => {
      this.watchSilence();
      this.dispatchEvent(new CustomEvent("data", { detail: event.data }));
    };
    socket.onclose = () => this.drop(socket);
    this.socket = socket;
  }

  get isOpen() {
    return this.socket?.readyState === WebSocket.OPEN;
  }

  /** Bytes that have not left yet: a choked link must not be fed with motion. */
  get backlog() {
    return this.socket?.bufferedAmount ?? 0;
  }

  /**
   * @param {string} text
   * @returns {boolean} false when there is no open socket: nothing is kept for later
   */
  send(text) {
    if (!this.isOpen) return false;
    this.socket?.send(text);
    return true;
  }

  /** Try again now, whatever the back-off says. */
  retryNow() {
    if (this.socket) this.drop(this.socket);
    this.waitMs = FIRST_WAIT_MS;
    this.open();
  }

  watchSilence() {
    clearTimeout(this.silenceTimer);
    const { socket } = this;
    if (this.silenceMs && socket) this.silenceTimer = setTimeout(() => this.drop(socket), this.silenceMs);
  }

  /** @param {WebSocket} socket that has closed, or is given up */
  drop(socket) {
    if (socket !== this.socket) return;
    this.socket = null;
    socket.onclose = socket.onmessage = socket.onopen = null;
    socket.close();
    clearTimeout(this.silenceTimer);
    clearTimeout(this.retryTimer);
    this.announce("waiting", this.waitMs);
    this.retryTimer = setTimeout(() => this.open(), this.waitMs);
    this.waitMs = Math.min(LONGEST_WAIT_MS, this.waitMs * 2);
    void this.askWhy();
  }

  /** A browser hides why a socket was refused; a plain request tells. */
  async askWhy() {
    try {
      const { status } = await fetch(this.probeUrl, { cache: "no-store" });
      if ((status === 401 || status === 403) && !this.isOpen) this.announce("refused", this.waitMs);
    } catch {
      // The server is away: "waiting" has said so.
    }
  }

  /** @param {LinkStage} stage @param {number} retryMs */
  announce(stage, retryMs) {
    this.dispatchEvent(new CustomEvent("state", { detail: { stage, retryMs } }));
  }
}
