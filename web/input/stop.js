/**
 * Every way to stop that is not a release: the STOP button, Space, Escape, and the page losing its
 * operator. STOP latches; losing the operator stops and ends a running task.
 */
export class Stop {
  /**
   * @param {import("../net/control_socket.js").ControlSocket} socket
   * @param {import("../net/situation.js").Situation} situation
   * @param {import("./drive.js").Drive} drive
   * @param {import("./arm.js").Arm} arm
   */
  constructor(socket, situation, drive, arm) {
    this.socket = socket;
    this.situation = situation;
    this.drive = drive;
    this.arm = arm;
  }

  /** @param {HTMLElement} button acts on the way down: a stop does not wait for the finger to lift */
  bind(button) {
    button.addEventListener("pointerdown", (event) => {
      if (event.button === 0) this.emergency();
    });
    button.addEventListener("keydown", (event) => event.key === "Enter" && this.emergency());
    button.addEventListener("click", (event) => {
      // A screen reader's activation comes without a pointer.
      if (event.detail === 0) this.emergency();
    });
  }

  /** Listens for the operator's leaving. */
  watch() {
    window.addEventListener("blur", () => this.leave("blur"));
    window.addEventListener("pagehide", () => this.leave("pagehide"));
    document.addEventListener("visibilitychange", () => document.hidden && this.leave("hidden"));
  }

  emergency() {
    this.drive.letGo();
    this.arm.halt();
    void this.socket.send({ type: "emergency_stop" });
  }

  /** @param {"blur" | "hidden" | "pagehide"} reason */
  leave(reason) {
    this.arm.halt();
    this.socket.feed(null);
    if (this.situation.holdsLease || this.drive.isDriving) this.drive.halt(reason);
  }
}
