/** One short sentence at a time, gone by itself. */
import { byId, setText } from "./dom.js";

const SHOWN_MS = 4500;

export class Toast {
  constructor() {
    this.element = byId("toast");
    this.timer = 0;
  }

  /** @param {string} sentence @param {"bad" | "plain"} tone */
  tell(sentence, tone = "plain") {
    const text = sentence.charAt(0).toUpperCase() + sentence.slice(1);
    setText(this.element, text);
    this.element.dataset.tone = tone;
    this.element.hidden = false;
    clearTimeout(this.timer);
    this.timer = setTimeout(() => (this.element.hidden = true), SHOWN_MS);
  }
}
