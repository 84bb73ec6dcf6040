/**
 * Press and hold on a button, by finger, mouse, pen, or the Enter key while it has the focus. However the
 * hold ends (release, cancelled touch, capture taken away) `onEnd` is called exactly once.
 */
export class Hold {
  /**
   * @param {HTMLElement} button
   * @param {() => boolean} onBegin false: refused, no hold begins
   * @param {() => void} onEnd
   */
  constructor(button, onBegin, onEnd) {
    this.button = button;
    this.onBegin = onBegin;
    this.onEnd = onEnd;
    /** @type {number | "key" | null} which pointer holds */
    this.holder = null;
    button.addEventListener("pointerdown", (event) => this.pointerDown(event));
    for (const name of /** @type {const} */ (["pointerup", "pointercancel", "lostpointercapture"])) {
      button.addEventListener(name, (event) => this.end(event.pointerId));
    }
    button.addEventListener("contextmenu", (event) => event.preventDefault());
    button.addEventListener("keydown", (event) => {
      if (event.key === "Enter" && !event.repeat) this.begin("key");
    });
    button.addEventListener("keyup", (event) => event.key === "Enter" && this.end("key"));
    button.addEventListener("blur", () => this.end("key"));
  }

  /** @param {PointerEvent} event */
  pointerDown(event) {
    if (event.button !== 0) return;
    event.preventDefault();
    this.button.focus({ preventScroll: true });
    if (this.begin(event.pointerId)) this.button.setPointerCapture(event.pointerId);
  }

  /** @param {number | "key"} holder @returns {boolean} */
  begin(holder) {
    if (this.holder !== null || !this.onBegin()) return false;
    this.holder = holder;
    this.button.classList.add("is-held");
    return true;
  }

  /** @param {number | "key"} holder */
  end(holder) {
    if (this.holder === null || this.holder !== holder) return;
    this.holder = null;
    this.button.classList.remove("is-held");
    this.onEnd();
  }
}
