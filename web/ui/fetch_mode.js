/** How far fetching goes by itself: plan only, ask first, or at once. The choice is kept in this browser. */
import { byId } from "./dom.js";

/** @typedef {"plan" | "confirm" | "go"} Mode */

const KEPT = "tapreach.fetch-mode";
/** @type {Mode[]} */
const MODES = ["plan", "confirm", "go"];

export class FetchMode {
  constructor() {
    const kept = /** @type {Mode} */ (localStorage.getItem(KEPT));
    /** @type {Mode} */
    this.chosen = "confirm";
    for (const mode of MODES) byId(`mode-${mode}`).addEventListener("click", () => this.choose(mode));
    this.choose(MODES.includes(kept) ? kept : "confirm");
  }

  /** @param {Mode} mode */
  choose(mode) {
    this.chosen = mode;
    localStorage.setItem(KEPT, mode);
    for (const other of MODES) byId(`mode-${other}`).setAttribute("aria-checked", String(other === mode));
  }
}
