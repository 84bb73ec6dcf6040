/** Composition: makes the parts and joins them. Nothing is decided here. */
import { Aim } from "./input/aim.js";
import { Arm } from "./input/arm.js";
import { Drive } from "./input/drive.js";
import { GamepadInput } from "./input/gamepad.js";
import { Keyboard } from "./input/keyboard.js";
import { Stop } from "./input/stop.js";
import { Tap } from "./input/tap.js";
import { ClockOffset } from "./net/clock_offset.js";
import { ControlSocket } from "./net/control_socket.js";
import { Situation } from "./net/situation.js";
import { VideoSocket } from "./net/video_socket.js";
import { Captures } from "./ui/captures.js";
import { byId } from "./ui/dom.js";
import { Emergency } from "./ui/emergency.js";
import { FetchMode } from "./ui/fetch_mode.js";
import { FetchPanel } from "./ui/fetch_panel.js";
import { Guide } from "./ui/guide.js";
import { Hints } from "./ui/hints.js";
import { Lease } from "./ui/lease.js";
import { Lesson } from "./ui/lesson.js";
import { Pads } from "./ui/pads.js";
import { PlaybackBar } from "./ui/playback_bar.js";
import { Popovers } from "./ui/popovers.js";
import { Purpose } from "./ui/purpose.js";
import { StatusBar } from "./ui/status_bar.js";
import { STEPS_DEG, StepMenu } from "./ui/step_menu.js";
import { TargetCard } from "./ui/target_card.js";
import { TaskPanel } from "./ui/task_panel.js";
import { Toast } from "./ui/toast.js";
import { Veil } from "./ui/veil.js";
import { deviceName } from "./net/device_name.js";
import { Boxes } from "./view/boxes.js";
import { Freshness } from "./view/freshness.js";
import { Overlay } from "./view/overlay.js";
import { Picture } from "./view/picture.js";
import { Plan } from "./view/plan.js";
import { Playback } from "./view/playback.js";
import { Targets } from "./view/targets.js";

const FEED_MS = 40;
const PROBE = "/api/captures";
const socketBase = `${location.protocol === "https:" ? "wss" : "ws"}://${location.host}`;

const control = new ControlSocket(`${socketBase}/ws/control`, PROBE, deviceName(navigator.userAgent));
const video = new VideoSocket(`${socketBase}/ws/video`, PROBE);
const situation = new Situation();
const clock = new ClockOffset();
const toast = new Toast();

const picture = new Picture(byId("picture"));
const playback = new Playback(picture, (frameId) => video.acknowledge(frameId));
const freshness = new Freshness(situation, clock);
const targets = new Targets();
const overlay = new Overlay(targets);
const boxes = new Boxes(targets);
const plan = new Plan(byId("plan"));

const drive = new Drive(control, situation);
const arm = new Arm(control, situation);
const stop = new Stop(control, situation, drive, arm);
const tap = new Tap(picture);

const popovers = new Popovers();
const hints = new Hints();
const lease = new Lease(control, situation, toast);
const guide = new Guide(control, toast);
const lesson = new Lesson(control, situation, toast);
const captures = new Captures(control, toast);
const fetchMode = new FetchMode();
const fetchPanel = new FetchPanel(control, toast);
const taskPanel = new TaskPanel(control, toast);
const stepMenu = new StepMenu(arm, popovers);
const pads = new Pads(drive, arm, situation);
const purpose = new Purpose();
const aim = new Aim({ socket: control, guide, purpose, fetchMode, overlay, boxes, playback, toast });
new StatusBar(situation);
new TargetCard(control, targets, fetchMode, toast);
new PlaybackBar(playback);
new Emergency(control, situation, toast);
new Veil(situation, () => {
  control.retryNow();
  video.retryNow();
});

/**
 * @template T
 * @param {EventTarget} source
 * @param {string} name
 * @param {(detail: T) => void} listener
 */
function on(source, name, listener) {
  source.addEventListener(name, (event) => listener(/** @type {CustomEvent<T>} */ (event).detail));
}

function drawPlan() {
  const { state, welcome } = situation.facts;
  if (!state?.odometry || !welcome || byId("card").hidden) return;
  const halfView = Math.atan(welcome.camera.width / 2 / welcome.camera.fx);
  plan.draw(state.odometry, targets.all(), halfView, taskPanel.move, fetchPanel.view);
}

function joinControl() {
  on(control, "link", (/** @type {import("./net/link.js").LinkState} */ link) => {
    if (link.stage !== "open") {
      taskPanel.clear();
      fetchPanel.show(null);
      lesson.hide();
      targets.clear();
      situation.learn({ link, welcome: null, state: null });
    } else situation.learn({ link });
  });
  on(control, "welcome", (/** @type {import("./net/messages.js").Welcome} */ welcome) => {
    clock.reset();
    picture.cameraSize = welcome.camera;
    lease.welcome();
    situation.learn({ welcome });
    void captures.refresh();
    if (!video.link.isOpen) video.retryNow();
  });
  on(control, "pong", (/** @type {{message: import("./net/messages.js").Pong, atMs: number}} */ { message, atMs }) => {
    clock.add(message.client_ms, message.server_ns, atMs);
    situation.learn({ rttMs: clock.rttMs });
  });
  on(control, "state", (/** @type {import("./net/messages.js").State} */ state) => {
    situation.learn({ state });
    taskPanel.showOwnMove(state.own_move);
    drawPlan();
  });
  on(control, "task", (/** @type {import("./net/messages.js").TaskView} */ task) => taskPanel.show(task));
  on(control, "move", (/** @type {import("./net/messages.js").MoveView} */ move) => {
    taskPanel.showMove(move);
    drawPlan();
  });
  on(control, "fetch", (/** @type {import("./net/messages.js").FetchView} */ view) => {
    fetchPanel.show(view);
    drawPlan();
  });
  on(control, "target", (/** @type {import("./net/messages.js").TargetView} */ target) => targets.put(target));
  on(control, "target_gone", (/** @type {import("./net/messages.js").TargetGone} */ gone) => targets.remove(gone.target_id));
  on(control, "guide", (/** @type {import("./net/messages.js").GuideView} */ view) => guide.show(view));
  on(control, "lesson", (/** @type {import("./net/messages.js").LessonView} */ view) => lesson.show(view));
  on(control, "captures_changed", () => void captures.refresh());
}

function joinPicture() {
  for (const layer of [boxes, overlay]) {
    picture.painters.push((ctx, placement, frame) => layer.paint(ctx, placement, frame));
  }
  on(video, "frame", (/** @type {import("./net/video_message.js").Frame} */ frame) => playback.receive(frame));
  on(video, "broken", (/** @type {string} */ reason) => toast.tell(reason, "bad"));
  on(video, "link", () => playback.forgetOwed());
  on(picture, "painted", (/** @type {import("./net/video_message.js").Frame} */ frame) => freshness.painted(frame));
  on(playback, "change", () => situation.learn({ isPaused: playback.isPaused }));
  on(targets, "change", () => {
    picture.repaint();
    drawPlan();
  });
  on(tap, "tap", (/** @type {import("./view/picture.js").PicturePoint} */ point) => {
    hints.done("tap");
    void aim.at(point);
  });
  tap.allowsBox = () => !guide.wantsTap;
  on(tap, "drawing", (/** @type {import("./view/boxes.js").PictureBox | null} */ box) => aim.draw(box));
  on(tap, "refused", (/** @type {string} */ reason) => toast.tell(reason));
  on(tap, "box", (/** @type {import("./input/tap.js").BoxedPart} */ box) => {
    hints.done("tap");
    void aim.around(box);
  });
}

function joinInput() {
  const capture = () => void captures.take(playback.isPaused ? situation.facts.frameId : null);
  const pause = () => playback.toggle();
  const pace = () => pads.changePace();
  const steps = Object.fromEntries(STEPS_DEG.map((step, index) => [`Digit${index + 1}`, () => stepMenu.choose(step)]));
  const keyActions = { ...steps, KeyC: capture, KeyP: pause, ShiftLeft: pace, ShiftRight: pace };
  new Keyboard({ drive, arm, stop, actions: keyActions }).listen();
  new GamepadInput({ drive, arm, stop, actions: { 0: capture, 2: pause, 3: pace } }).listen();
  on(drive, "refused", (/** @type {string} */ reason) => toast.tell(reason));
  on(arm, "refused", (/** @type {string} */ reason) => toast.tell(reason));
  on(drive, "driving", () => hints.done("drive"));
  byId("capture").addEventListener("click", capture);
  stop.bind(byId("stop"));
  stop.watch();
}

function joinMenus() {
  popovers.bind("step-menu", "step-open");
  popovers.bind("menu", "menu-open");
  popovers.bind("captures", "captures-open");
  for (const id of ["captures-close", "keys-close"]) byId(id).addEventListener("click", () => popovers.close());
  /** @type {[string, () => void][]} */
  const items = [
    ["guide-two-tap", () => guide.start("two_tap")],
    ["guide-rotation", () => guide.start("rotation_centre")],
    ["menu-lessons", () => lesson.choose()],
    ["menu-keys", () => popovers.toggle("keys", "menu-open")],
    ["menu-hints", () => hints.again()],
  ];
  for (const [id, act] of items) {
    byId(id).addEventListener("click", () => {
      popovers.close();
      act();
    });
  }
}

/** The worker's token: this page is awake, seen, and may drive. */
function feedHeartbeat() {
  freshness.check();
  const isOperator = situation.holdsLease && !document.hidden;
  control.feed(isOperator ? { atMs: performance.now(), frameId: situation.facts.frameId } : null);
}

joinControl();
joinPicture();
joinInput();
joinMenus();
hints.show();
control.open();
video.open();
setInterval(feedHeartbeat, FEED_MS);
