/** The latched stop: who pressed it, and Resume for whoever drives. */
import { byId, setText } from "./dom.js";

export class Emergency {
  /**
   * @param {import("../net/control_socket.js").ControlSocket} socket
   * @param {import("../net/situation.js").Situation} situation
   * @param {import("./toast.js").Toast} toast
   */
  constructor(socket, situation, toast) {
    this.situation = situation;
    situation.addEventListener("change", () => this.show());
    byId("resume").addEventListener("click", async () => {
      const ack = await socket.send({ type: "emergency_reset" });
      if (!ack.ok) toast.tell(ack.reason, "bad");
    });
  }

  show() {
    const { facts, holdsLease, isConnected } = this.situation;
    const why = (isConnected && facts.state?.emergency_stop) || "";
    byId("stopped").hidden = !why;
    byId("resume").hidden = !holdsLease;
    setText(byId("stopped-text"), holdsLease ? why : `${why}. Only the driver can resume.`);
    document.body.classList.toggle("is-stopped", Boolean(why));
  }
}
