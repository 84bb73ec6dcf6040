/**
 * Keys do what the buttons do. Places on the keyboard, not letters, for driving and the arm, so that other
 * layouts work alike. Space and Escape stop, whatever has the focus.
 *
 * @typedef {import("./drive.js").Wish} Wish
 * @typedef {import("./arm.js").ArmControl} ArmControl
 */
/** @type {Record<string, Wish>} */
const DRIVE_KEYS = {
  ArrowUp: { ahead: 1, left: 0 },
  ArrowDown: { ahead: -1, left: 0 },
  ArrowLeft: { ahead: 0, left: 1 },
  ArrowRight: { ahead: 0, left: -1 },
  KeyW: { ahead: 1, left: 0 },
  KeyS: { ahead: -1, left: 0 },
  KeyA: { ahead: 0, left: 1 },
  KeyD: { ahead: 0, left: -1 },
};
/** @type {Record<string, ArmControl>} */
const ARM_KEYS = { KeyT: "T", KeyR: "R", KeyJ: "left", KeyL: "right", KeyI: "forward", KeyK: "backward" };

export class Keyboard {
  /**
   * @param {{drive: import("./drive.js").Drive, arm: import("./arm.js").Arm, stop: import("./stop.js").Stop,
   *   actions: Record<string, () => void>}} parts `actions`: what other keys do, by code
   */
  constructor({ drive, arm, stop, actions }) {
    this.drive = drive;
    this.arm = arm;
    this.stop = stop;
    this.actions = actions;
  }

  listen() {
    // Capturing: a dialog or a focused button must not swallow a stop.
    window.addEventListener("keydown", (event) => this.down(event), true);
    window.addEventListener("keyup", (event) => this.up(event), true);
  }

  /** @param {KeyboardEvent} event */
  down(event) {
    if (isStop(event)) {
      event.preventDefault();
      if (!event.repeat) this.stop.emergency();
      return;
    }
    if (event.repeat || event.ctrlKey || event.metaKey || event.altKey || isTyping(event)) return;
    if (this.begin(event.code)) event.preventDefault();
  }

  /** @param {string} code @returns {boolean} whether the key means anything */
  begin(code) {
    const wish = DRIVE_KEYS[code];
    const control = ARM_KEYS[code];
    const action = this.actions[code];
    if (wish) this.drive.press(code, wish);
    else if (control) this.arm.press(code, control);
    else if (action) action();
    return Boolean(wish || control || action);
  }

  /** @param {KeyboardEvent} event */
  up(event) {
    // A focused button would act on the release of Space.
    if (isStop(event)) event.preventDefault();
    this.drive.release(event.code);
    this.arm.release(event.code);
  }
}

/** @param {KeyboardEvent} event @returns {boolean} */
const isStop = (event) => event.code === "Escape" || (event.code === "Space" && !isText(event.target));

/** @param {EventTarget | null} target @returns {boolean} whether a person writes there */
const isText = (target) => target instanceof HTMLInputElement && target.type !== "range";

/** @param {KeyboardEvent} event @returns {boolean} whether keys belong to a field or slider now */
const isTyping = (event) => event.target instanceof HTMLInputElement;
