/** One short sentence at a time, gone by itself. */
import { sentence } from "../view/words.js";
import { byId, setText } from "./dom.js";

const SHOWN_MS = 4500;

export class Toast {
  constructor() {
    this.element = byId("toast");
    this.timer = 0;
  }

  /** @param {string} words @param {"bad" | "plain"} tone */
  tell(words, tone = "plain") {
    setText(this.element, sentence(words));
    this.element.dataset.tone = tone;
    this.element.hidden = false;
    clearTimeout(this.timer);
    this.timer = setTimeout(() => (this.element.hidden = true), SHOWN_MS);
  }
}
