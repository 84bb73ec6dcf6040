/** The paper's buttons: four to drive, six for the arm; and the pace. */
import { Hold } from "../input/hold.js";
import { byId } from "./dom.js";

/** @type {Record<string, import("../input/drive.js").Wish>} */
const WISHES = {
  forward: { ahead: 1, left: 0 },
  backward: { ahead: -1, left: 0 },
  left: { ahead: 0, left: 1 },
  right: { ahead: 0, left: -1 },
};
const SLOW = 0.35;

export class Pads {
  /**
   * @param {import("../input/drive.js").Drive} drive
   * @param {import("../input/arm.js").Arm} arm
   * @param {import("../net/situation.js").Situation} situation
   */
  constructor(drive, arm, situation) {
    this.drive = drive;
    this.arm = arm;
    for (const button of document.querySelectorAll("[data-drive]")) this.bindDrive(/** @type {HTMLElement} */ (button));
    for (const button of document.querySelectorAll("[data-arm]")) this.bindArm(/** @type {HTMLElement} */ (button));
    byId("pace").addEventListener("click", () => this.changePace());
    situation.addEventListener("change", () => {
      document.body.classList.toggle("cannot-drive", situation.driveRefusal !== "");
      document.body.classList.toggle("cannot-move", situation.moveRefusal !== "");
    });
  }

  /** @param {HTMLElement} button */
  bindDrive(button) {
    const source = `button ${button.dataset.drive}`;
    const wish = WISHES[button.dataset.drive ?? ""];
    if (!wish) throw new RangeError(`no way to drive "${button.dataset.drive}"; there are ${Object.keys(WISHES)}`);
    new Hold(button, () => this.drive.press(source, wish), () => this.drive.release(source));
  }

  /** @param {HTMLElement} button */
  bindArm(button) {
    const control = /** @type {import("../input/arm.js").ArmControl} */ (button.dataset.arm);
    const source = `button ${control}`;
    new Hold(button, () => this.arm.press(source, control), () => this.arm.release(source));
  }

  changePace() {
    const isSlow = this.drive.pace === 1;
    this.drive.pace = isSlow ? SLOW : 1;
    byId("pace").setAttribute("aria-pressed", String(isSlow));
  }
}
