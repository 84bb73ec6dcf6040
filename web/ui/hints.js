/**
 * Three hints on first start, one at a time. Doing the thing is as good as pressing Next. Remembered, so
 * that they come once.
 */
import { byId, setText } from "./dom.js";

const STORAGE_KEY = "tapreach.hints";
const HINTS = [
  { id: "drive", title: "Hold to drive", text: "Let go and the robot stops." },
  { id: "tap", title: "Tap the red can", text: "The robot moves a little to find it. Draw a box around it for its size." },
  { id: "sure", title: "This is how sure it is", text: "The outlined region holds the target 95 times in 100." },
];

export class Hints {
  constructor() {
    this.index = Number(remembered());
    byId("hint-next").addEventListener("click", () => this.goTo(this.index + 1));
    byId("hint-close").addEventListener("click", () => this.goTo(HINTS.length));
  }

  /** @param {"drive" | "tap"} id what the person has just done */
  done(id) {
    if (HINTS[this.index]?.id === id) this.goTo(this.index + 1);
  }

  again() {
    this.goTo(0);
  }

  /** @param {number} index */
  goTo(index) {
    this.index = index;
    remember(String(index));
    this.show();
  }

  show() {
    const hint = HINTS[this.index];
    byId("hint").hidden = !hint;
    document.body.dataset.hint = hint?.id ?? "";
    if (!hint) return;
    setText(byId("hint-title"), hint.title);
    setText(byId("hint-text"), hint.text);
    setText(byId("hint-next"), this.index === HINTS.length - 1 ? "Done" : "Next");
  }
}

/** Storage may be forbidden: then the hints come each time. */
function remembered() {
  try {
    return localStorage.getItem(STORAGE_KEY) ?? "0";
  } catch {
    return "0";
  }
}

/** @param {string} value */
function remember(value) {
  try {
    localStorage.setItem(STORAGE_KEY, value);
  } catch {
    // See remembered().
  }
}
