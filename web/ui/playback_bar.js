/** Pause, the slider over the last seconds, and back to live. */
import { number } from "../view/words.js";
import { byId, setText } from "./dom.js";

export class PlaybackBar {
  /** @param {import("../view/playback.js").Playback} playback */
  constructor(playback) {
    this.playback = playback;
    this.slider = /** @type {HTMLInputElement} */ (byId("scrub-slider"));
    byId("pause").addEventListener("click", () => playback.toggle());
    this.slider.addEventListener("input", () => playback.scrub(-this.slider.valueAsNumber * 1000));
    playback.addEventListener("change", () => this.show());
  }

  show() {
    const { isPaused, backMs, spanMs } = this.playback;
    document.body.classList.toggle("is-paused", isPaused);
    byId("scrub").hidden = !isPaused;
    this.slider.min = String(-spanMs / 1000);
    this.slider.value = String(-backMs / 1000);
    setText(byId("scrub-time"), `${number(-backMs / 1000, 1)} s`);
    const pause = byId("pause");
    pause.setAttribute("aria-pressed", String(isPaused));
    pause.setAttribute("aria-label", isPaused ? "Go live" : "Pause the picture");
    byId("pause-icon").setAttribute("href", isPaused ? "#i-live" : "#i-pause");
    setText(byId("pause-text"), isPaused ? "Live" : "Pause");
  }
}
