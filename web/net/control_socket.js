/**
 * The page's end of the control socket, which lives in heartbeat_worker.js.
 *
 * Events: "link" (detail LinkState), "pong" (detail {message, atMs}), and one per message type of the
 * server ("welcome", "state", "task", "target", "target_gone", "guide", "captures_changed"; detail: it).
 *
 * @typedef {import("./messages.js").FromPage} FromPage
 * @typedef {import("./messages.js").Ack} Ack
 * @typedef {import("./link.js").LinkState} LinkState
 */
/**
 * @template T
 * @typedef {T extends unknown ? Omit<T, "seq"> : never} WithoutSeq
 */
/**
 * @typedef {WithoutSeq<FromPage>} Unnumbered a message before the worker numbers it
 * @typedef {{kind: "open", url: string, probeUrl: string, pageOriginMs: number, name: string}
 *   | {kind: "token", token: import("./heartbeat.js").Token | null}
 *   | {kind: "send", message: Unnumbered, ticket: number, isMotion: boolean}
 *   | {kind: "retry"}} ToWorker
 * @typedef {{kind: "link", state: LinkState}
 *   | {kind: "message", message: any, ticket: number | null, atMs: number}
 *   | {kind: "unsent", ticket: number}} FromWorker
 */

const UNSENT = "not sent: there is no connection to the robot";

export class ControlSocket extends EventTarget {
  /** @param {string} url @param {string} probeUrl @param {string} name shown to others */
  constructor(url, probeUrl, name) {
    super();
    this.target = { url, probeUrl, name };
    this.nextTicket = 0;
    /** @type {Map<number, (ack: Ack) => void>} */
    this.waiting = new Map();
    this.worker = new Worker(new URL("./heartbeat_worker.js", import.meta.url), { type: "module" });
    this.worker.onmessage = (event) => this.receive(event.data);
  }

  open() {
    this.tell({ kind: "open", ...this.target, pageOriginMs: performance.timeOrigin });
  }

  /**
   * @param {Unnumbered} message
   * @returns {Promise<Ack>} never rejects: a message that could not leave is an ack that is not ok
   */
  send(message) {
    this.nextTicket += 1;
    const ticket = this.nextTicket;
    const isMotion = message.type === "drive" || message.type === "arm_step";
    return new Promise((resolve) => {
      this.waiting.set(ticket, resolve);
      this.tell({ kind: "send", message, ticket, isMotion });
    });
  }

  /** @param {import("./heartbeat.js").Token | null} token null: stop the heartbeat */
  feed(token) {
    this.tell({ kind: "token", token });
  }

  retryNow() {
    this.tell({ kind: "retry" });
  }

  /** @param {ToWorker} message */
  tell(message) {
    this.worker.postMessage(message);
  }

  /** @param {FromWorker} event */
  receive(event) {
    if (event.kind === "link") this.announce("link", event.state);
    else if (event.kind === "unsent") this.settle(event.ticket, { type: "ack", seq: null, ok: false, reason: UNSENT, sent: null });
    else if (event.message.type === "pong") this.announce("pong", event);
    else if (event.message.type === "ack") this.settle(event.ticket, event.message);
    else this.announce(event.message.type, event.message);
  }

  /** @param {number | null} ticket @param {Ack} ack */
  settle(ticket, ack) {
    if (ticket === null) return;
    this.waiting.get(ticket)?.(ack);
    this.waiting.delete(ticket);
  }

  /** @param {string} name @param {unknown} detail */
  announce(name, detail) {
    this.dispatchEvent(new CustomEvent(name, { detail }));
  }
}
