/**
 * The targets the server knows, newest last. Event "change".
 *
 * @typedef {import("../net/messages.js").TargetView} TargetView
 */
export class Targets extends EventTarget {
  constructor() {
    super();
    /** @type {Map<number, TargetView>} */
    this.byId = new Map();
  }

  /** @param {TargetView} target new, or newer than the one of that id */
  put(target) {
    this.byId.set(target.target_id, target);
    this.dispatchEvent(new CustomEvent("change"));
  }

  /** @param {number} targetId */
  remove(targetId) {
    this.byId.delete(targetId);
    this.dispatchEvent(new CustomEvent("change"));
  }

  clear() {
    this.byId.clear();
    this.dispatchEvent(new CustomEvent("change"));
  }

  /** @returns {TargetView | null} the one the card shows */
  get newest() {
    return [...this.byId.values()].at(-1) ?? null;
  }

  /** @returns {TargetView[]} */
  all() {
    return [...this.byId.values()];
  }
}
