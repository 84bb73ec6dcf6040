/** The running task: phase, progress, the move it makes and what that should bring, and a Cancel. */
import { expectation, sentence } from "../view/words.js";
import { byId, setText } from "./dom.js";

/**
 * @typedef {import("../net/messages.js").TaskView} TaskView
 * @typedef {import("../net/messages.js").MoveView} MoveView
 */

/** Tasks whose end nothing else on the page tells. */
const TOLD_WHEN_DONE = new Set(["put_down", "let_go", "bring_back", "hand_over"]);

export class TaskPanel {
  /**
   * @param {import("../net/control_socket.js").ControlSocket} socket
   * @param {import("./toast.js").Toast} toast
   */
  constructor(socket, toast) {
    this.toast = toast;
    /** @type {TaskView | null} */
    this.task = null;
    /** @type {MoveView | null} the move that is being made */
    this.move = null;
    byId("task-cancel").addEventListener("click", () => void socket.send({ type: "task_cancel" }));
  }

  /** @param {TaskView} task */
  show(task) {
    const wasRunning = this.task?.task_id === task.task_id && this.task.state === "running";
    this.task = task;
    // A lesson has a panel of its own, which also tells its end.
    byId("task").hidden = task.state !== "running" || task.kind === "lesson";
    setText(byId("task-phase"), sentence((task.phase || task.kind).replaceAll("_", " ")));
    setText(byId("task-message"), task.message);
    byId("task-progress").setAttribute("value", String(task.progress));
    if (wasRunning && task.kind !== "lesson" && task.state !== "running") this.tellEnd(task);
  }

  /** @param {MoveView} move one without tracks says that it is over */
  showMove(move) {
    this.move = move.tracks_in_world.length > 0 ? move : null;
    const words = this.move ? expectation(this.move) : "";
    byId("task-expects").hidden = words === "";
    setText(byId("task-expects"), words && `expects ${words}`);
  }

  /** How far the robot is with a move that it makes by itself. @param {number | null} done from 0 to 1 */
  showOwnMove(done) {
    byId("task-move").hidden = done === null;
    if (done !== null) setText(byId("task-move"), `${Math.floor(100 * done)} % of this move`);
  }

  /** A lost connection ends what the page knows of a task. */
  clear() {
    this.task = this.move = null;
    byId("task").hidden = byId("task-expects").hidden = byId("task-move").hidden = true;
  }

  /** @param {TaskView} task */
  tellEnd(task) {
    if (task.state === "cancelled") this.toast.tell(task.message || "Cancelled. The robot stands still.");
    if (task.state === "done" && TOLD_WHEN_DONE.has(task.kind)) this.toast.tell(sentence(task.message));
    if (task.state === "failed") this.toast.tell(task.message || "This did not work.", "bad");
  }
}
