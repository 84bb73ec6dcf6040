/** Small menus and sheets that open from a button: one at a time, closed by a tap elsewhere. STOP stays free. */
import { byId } from "./dom.js";

export class Popovers {
  constructor() {
    /** @type {{panel: HTMLElement, opener: HTMLElement} | null} */
    this.open = null;
    document.addEventListener("pointerdown", (event) => {
      const node = /** @type {Node} */ (event.target);
      const { open } = this;
      if (open?.panel.classList.contains("popover") && !open.panel.contains(node) && !open.opener.contains(node)) {
        this.close();
      }
    });
  }

  /** @param {string} panelId @param {string} openerId */
  bind(panelId, openerId) {
    byId(openerId).addEventListener("click", () => this.toggle(panelId, openerId));
  }

  /** @param {string} panelId @param {string} openerId whose focus comes back */
  toggle(panelId, openerId) {
    const panel = byId(panelId);
    const wasOpen = this.open?.panel === panel;
    this.close();
    if (wasOpen) return;
    panel.hidden = false;
    byId(openerId).setAttribute("aria-expanded", "true");
    this.open = { panel, opener: byId(openerId) };
    panel.querySelector("button")?.focus({ preventScroll: true });
  }

  close() {
    if (!this.open) return;
    const { panel, opener } = this.open;
    const hadFocus = panel.contains(document.activeElement);
    panel.hidden = true;
    opener.setAttribute("aria-expanded", "false");
    this.open = null;
    if (hadFocus) opener.focus({ preventScroll: true });
  }
}
