/**
 * Hold to drive. Sources (buttons, keys, sticks) each hold a wish; the sum goes out at 20 Hz while any is
 * held. When the last lets go, or anything speaks against driving, a stop goes out at once, and a source
 * that was cut off must let go and press anew.
 *
 * Events: "driving" at each press, "refused" (detail: the reason in a plain sentence).
 *
 * @typedef {{ahead: number, left: number}} Wish each −1 to 1, as a share of the pace
 * @typedef {"release" | "blur" | "hidden" | "pagehide" | "button" | "key"} StopReason
 */
const PERIOD_MS = 50;

export class Drive extends EventTarget {
  /**
   * @param {import("../net/control_socket.js").ControlSocket} socket
   * @param {import("../net/situation.js").Situation} situation
   */
  constructor(socket, situation) {
    super();
    this.socket = socket;
    this.situation = situation;
    /** @type {Map<string, Wish>} */
    this.wishes = new Map();
    /** Share of the robot's top speed. */
    this.pace = 1;
    this.timer = 0;
    situation.addEventListener("change", () => this.obey());
  }

  get isDriving() {
    return this.wishes.size > 0;
  }

  /**
   * @param {string} source
   * @param {Wish} wish
   * @returns {boolean} false when refused
   */
  press(source, wish) {
    const refusal = this.situation.driveRefusal;
    if (refusal) {
      this.dispatchEvent(new CustomEvent("refused", { detail: refusal }));
      return false;
    }
    this.wishes.set(source, wish);
    if (!this.timer) this.timer = setInterval(() => this.tick(), PERIOD_MS);
    this.tick();
    this.dispatchEvent(new CustomEvent("driving"));
    return true;
  }

  /** @param {string} source */
  release(source) {
    if (this.wishes.delete(source) && !this.isDriving) this.halt("release");
  }

  /** Zero speed now, whoever holds. @param {StopReason} reason */
  halt(reason) {
    this.letGo();
    void this.socket.send({ type: "stop", reason });
  }

  /** Forget every wish, without a word to the robot: for who tells it something stronger. */
  letGo() {
    this.wishes.clear();
    clearInterval(this.timer);
    this.timer = 0;
  }

  /** Cut off when what allowed driving is gone. */
  obey() {
    const refusal = this.isDriving ? this.situation.driveRefusal : "";
    if (!refusal) return;
    this.halt("release");
    this.dispatchEvent(new CustomEvent("refused", { detail: refusal }));
  }

  tick() {
    this.obey();
    const { welcome, frameId } = this.situation.facts;
    if (!this.isDriving || !welcome) return;
    const wish = this.sum();
    void this.socket.send({
      type: "drive",
      client_ms: performance.now(),
      frame_id: frameId,
      linear: wish.ahead * this.pace * welcome.max_linear,
      angular: wish.left * this.pace * welcome.max_angular,
    });
  }

  /** @returns {Wish} */
  sum() {
    let ahead = 0;
    let left = 0;
    for (const wish of this.wishes.values()) {
      ahead += wish.ahead;
      left += wish.left;
    }
    return { ahead: clampUnit(ahead), left: clampUnit(left) };
  }
}

/** @param {number} value */
const clampUnit = (value) => Math.min(1, Math.max(-1, value));
