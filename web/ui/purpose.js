/** What a tap on the picture does: Locate (the robot moves), Floor guess (at once), Fetch (drives and grips). */
import { byId } from "./dom.js";

/** @typedef {"locate" | "floor" | "fetch"} Chosen */

/** @type {Chosen[]} */
const PURPOSES = ["locate", "floor", "fetch"];

export class Purpose {
  constructor() {
    /** @type {Chosen} */
    this.chosen = "locate";
    for (const purpose of PURPOSES) byId(`purpose-${purpose}`).addEventListener("click", () => this.choose(purpose));
  }

  /** @param {Chosen} chosen */
  choose(chosen) {
    this.chosen = chosen;
    for (const purpose of PURPOSES) {
      byId(`purpose-${purpose}`).setAttribute("aria-checked", String(purpose === chosen));
    }
  }
}
