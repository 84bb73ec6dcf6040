/** The paper's drop-down: how far one press moves the arm. And the two named poses. */
import { byId, make, setText } from "./dom.js";

/** @typedef {import("../input/arm.js").StepDeg} StepDeg */

/** @type {readonly StepDeg[]} */
export const STEPS_DEG = [1, 5, 10, 20, 50];

export class StepMenu {
  /**
   * @param {import("../input/arm.js").Arm} arm
   * @param {import("./popovers.js").Popovers} popovers
   */
  constructor(arm, popovers) {
    this.arm = arm;
    this.popovers = popovers;
    this.buttons = STEPS_DEG.map((step) => this.makeButton(step));
    byId("steps").replaceChildren(...this.buttons);
    byId("pose-standard").addEventListener("click", () => this.goto("standard"));
    byId("pose-stowed").addEventListener("click", () => this.goto("stowed"));
    this.choose(arm.stepDeg);
  }

  /** @param {StepDeg} step */
  makeButton(step) {
    const button = make("button", { type: "button", role: "radio", text: `${step}°` });
    button.addEventListener("click", () => {
      this.choose(step);
      this.popovers.close();
    });
    return button;
  }

  /** @param {StepDeg} step */
  choose(step) {
    this.arm.stepDeg = step;
    setText(byId("step-value"), `${step}°`);
    this.buttons.forEach((button, index) => button.setAttribute("aria-checked", String(STEPS_DEG[index] === step)));
  }

  /** @param {"standard" | "stowed"} pose */
  goto(pose) {
    this.popovers.close();
    void this.arm.goto(pose);
  }
}
