/** What a tap on the picture does: Locate (the robot moves) or Floor guess (at once). */
import { byId } from "./dom.js";

export class Purpose {
  constructor() {
    /** @type {"locate" | "floor"} */
    this.chosen = "locate";
    byId("purpose-locate").addEventListener("click", () => this.choose("locate"));
    byId("purpose-floor").addEventListener("click", () => this.choose("floor"));
  }

  /** @param {"locate" | "floor"} purpose */
  choose(purpose) {
    this.chosen = purpose;
    byId("purpose-locate").setAttribute("aria-checked", String(purpose === "locate"));
    byId("purpose-floor").setAttribute("aria-checked", String(purpose === "floor"));
  }
}
