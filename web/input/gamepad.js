/**
 * A gamepad of the standard mapping: left stick drives, the cross and the shoulder buttons move the arm,
 * B stops, A captures, X pauses. Read at the screen's pace while one is connected.
 *
 * @typedef {import("./arm.js").ArmControl} ArmControl
 */
const DEAD_ZONE = 0.15;
const STOP_BUTTON = 1;
/** @type {Record<number, ArmControl>} */
const ARM_BUTTONS = { 4: "R", 5: "T", 12: "forward", 13: "backward", 14: "left", 15: "right" };

export class GamepadInput {
  /**
   * @param {{drive: import("./drive.js").Drive, arm: import("./arm.js").Arm, stop: import("./stop.js").Stop,
   *   actions: Record<number, () => void>}} parts `actions`: what other buttons do, by index
   */
  constructor({ drive, arm, stop, actions }) {
    this.drive = drive;
    this.arm = arm;
    this.stop = stop;
    this.actions = actions;
    /** @type {Set<number>} buttons that were down at the last look */
    this.down = new Set();
    this.isSteering = false;
  }

  listen() {
    window.addEventListener("gamepadconnected", () => this.poll());
  }

  poll() {
    const pad = navigator.getGamepads().find((candidate) => candidate?.mapping === "standard");
    this.read(pad?.axes ?? [], pad?.buttons ?? []);
    if (pad) requestAnimationFrame(() => this.poll());
  }

  /** @param {readonly number[]} axes @param {readonly {pressed: boolean}[]} buttons empty: unplugged, lets go of all */
  read(axes, buttons) {
    this.readStick(-withDeadZone(axes[1] ?? 0), -withDeadZone(axes[0] ?? 0));
    const pressed = new Set(buttons.flatMap((button, index) => (button.pressed ? [index] : [])));
    for (const index of pressed) if (!this.down.has(index)) this.press(index);
    for (const index of this.down) if (!pressed.has(index)) this.arm.release(`pad ${index}`);
    this.down = pressed;
  }

  /** @param {number} ahead @param {number} left */
  readStick(ahead, left) {
    const isOut = ahead !== 0 || left !== 0;
    // A stick that was cut off must come back to its middle first.
    if (isOut && !this.isSteering) this.drive.press("pad", { ahead, left });
    else if (isOut && this.drive.wishes.has("pad")) this.drive.wishes.set("pad", { ahead, left });
    else if (!isOut) this.drive.release("pad");
    this.isSteering = isOut;
  }

  /** @param {number} index */
  press(index) {
    const control = ARM_BUTTONS[index];
    if (index === STOP_BUTTON) this.stop.emergency();
    else if (control) this.arm.press(`pad ${index}`, control);
    else this.actions[index]?.();
  }
}

/** @param {number} value @returns {number} 0 inside the dead zone, continuous from there to ±1 */
export function withDeadZone(value) {
  const size = Math.abs(value);
  return size <= DEAD_ZONE ? 0 : (Math.sign(value) * (size - DEAD_ZONE)) / (1 - DEAD_ZONE);
}
