/**
 * Press for one step of the arm, hold to repeat. A step waits for the answer to the one before, so that
 * steps never pile up on a slow link.
 *
 * Event "refused" (detail: the reason).
 *
 * @typedef {"T" | "R" | "left" | "right" | "forward" | "backward"} ArmControl
 * @typedef {1 | 5 | 10 | 20 | 50} StepDeg
 */
const FIRST_REPEAT_MS = 400;
const REPEAT_MS = 200;

export class Arm extends EventTarget {
  /**
   * @param {import("../net/control_socket.js").ControlSocket} socket
   * @param {import("../net/situation.js").Situation} situation
   */
  constructor(socket, situation) {
    super();
    this.socket = socket;
    this.situation = situation;
    /** @type {StepDeg} */
    this.stepDeg = 5;
    /** @type {string | null} what is held */
    this.held = null;
    this.timer = 0;
  }

  /** @param {string} source @param {ArmControl} control @returns {boolean} false when refused */
  press(source, control) {
    const refusal = this.situation.moveRefusal;
    if (refusal) {
      this.refuse(refusal);
      return false;
    }
    this.halt();
    this.held = source;
    void this.step(source, control, FIRST_REPEAT_MS);
    return true;
  }

  /** @param {string} source */
  release(source) {
    if (this.held === source) this.halt();
  }

  halt() {
    this.held = null;
    clearTimeout(this.timer);
  }

  /** @param {string} source @param {ArmControl} control @param {number} waitMs until the next */
  async step(source, control, waitMs) {
    const begunMs = performance.now();
    const ack = await this.socket.send({
      type: "arm_step",
      client_ms: begunMs,
      frame_id: this.situation.facts.frameId,
      control,
      step_deg: this.stepDeg,
    });
    if (!ack.ok) {
      this.refuse(ack.reason);
      this.release(source);
    }
    if (this.held !== source || this.situation.moveRefusal) return;
    const restMs = Math.max(0, waitMs - (performance.now() - begunMs));
    this.timer = setTimeout(() => this.held === source && this.step(source, control, REPEAT_MS), restMs);
  }

  /** @param {"standard" | "stowed"} pose */
  async goto(pose) {
    const refusal = this.situation.moveRefusal;
    if (refusal) {
      this.refuse(refusal);
      return;
    }
    const ack = await this.socket.send({
      type: "arm_goto",
      client_ms: performance.now(),
      frame_id: this.situation.facts.frameId,
      pose,
    });
    if (!ack.ok) this.refuse(ack.reason);
  }

  /** @param {string} reason */
  refuse(reason) {
    this.dispatchEvent(new CustomEvent("refused", { detail: reason }));
  }
}
