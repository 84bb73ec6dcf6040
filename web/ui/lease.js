/**
 * Who drives: take the wheel, ask for it, hand it over, give it back. A page that opens on a robot nobody
 * drives takes the wheel itself, once; after giving it back it only takes it when told to.
 */
import { byId, setText } from "./dom.js";

export class Lease {
  /**
   * @param {import("../net/control_socket.js").ControlSocket} socket
   * @param {import("../net/situation.js").Situation} situation
   * @param {import("./toast.js").Toast} toast
   */
  constructor(socket, situation, toast) {
    this.socket = socket;
    this.situation = situation;
    this.toast = toast;
    this.takesFree = true;
    this.hasAsked = false;
    this.held = false;
    situation.addEventListener("change", () => this.show());
    byId("lease-action").addEventListener("click", () => this.act());
    byId("asked-grant").addEventListener("click", () => this.answer(true));
    byId("asked-keep").addEventListener("click", () => this.answer(false));
  }

  get view() {
    return this.situation.isConnected ? (this.situation.facts.state?.lease ?? null) : null;
  }

  /** On every new connection. */
  welcome() {
    this.hasAsked = false;
  }

  act() {
    if (this.situation.holdsLease) {
      this.takesFree = false;
      void this.socket.send({ type: "stop", reason: "button" });
      void this.socket.send({ type: "lease_release" });
    } else {
      void this.ask();
    }
  }

  async ask() {
    this.hasAsked = true;
    this.takesFree = true;
    const ack = await this.socket.send({ type: "lease_request" });
    if (!ack.ok) {
      this.hasAsked = false;
      this.toast.tell(ack.reason);
    }
    this.show();
  }

  /** @param {boolean} grant */
  answer(grant) {
    const session = this.view?.asked_by_id;
    if (session) void this.socket.send({ type: "lease_answer", session_id: session, grant });
  }

  show() {
    const { view } = this;
    const { holdsLease, sessionId } = this.situation;
    this.takeIfFree();
    if (holdsLease || (this.held && !holdsLease)) this.hasAsked = false;
    this.held = holdsLease;
    const action = byId("lease-action");
    action.hidden = view === null;
    if (view) setText(action, actionWords(view, holdsLease, this.hasAsked));
    action.toggleAttribute("disabled", this.hasAsked && view?.holder_id !== null && !view?.is_idle);
    action.classList.toggle("button--accent", !holdsLease);
    setText(byId("lease-who"), holderWords(view, holdsLease));
    byId("asked").hidden = !(holdsLease && view?.asked_by_id && view.asked_by_id !== sessionId);
    setText(byId("asked-who"), view?.asked_by_name || "Another session");
  }

  takeIfFree() {
    const { view } = this;
    if (!view || view.holder_id !== null || !this.takesFree || this.hasAsked || document.hidden) return;
    this.takesFree = false;
    void this.ask();
  }
}

/** @typedef {import("../net/messages.js").LeaseView} LeaseView */

/** @param {LeaseView} view @param {boolean} holdsLease @param {boolean} hasAsked */
function actionWords(view, holdsLease, hasAsked) {
  if (holdsLease) return "Give back";
  if (view.holder_id === null) return "Drive";
  if (view.is_idle) return "Take over";
  return hasAsked ? "Asked" : "Ask to drive";
}

/** @param {LeaseView | null} view @param {boolean} holdsLease */
function holderWords(view, holdsLease) {
  if (!view) return "–";
  if (holdsLease) return "You";
  if (view.holder_id === null) return "Nobody";
  return view.holder_name || `Session ${view.holder_id}`;
}
