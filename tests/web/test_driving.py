"""Hold to drive, and every way of stopping."""

import itertools

import pytest
from tests.web.conftest import wait_ready

FORWARD = "[data-drive=forward]"
LEFT = "[data-drive=left]"


def hold(page, selector):
    """Press the mouse on a button and keep it down."""
    box = page.locator(selector).bounding_box()
    page.mouse.move(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    page.mouse.down()


def drives_after_last_stop(server):
    kinds = [message["type"] for message in server.received if message["type"] in ("drive", "stop")]
    return kinds[::-1].index("stop") if "stop" in kinds else len(kinds)


def test_holding_sends_drive_at_20_hz_and_release_one_stop(server, open_page):
    page = open_page()
    hold(page, FORWARD)
    server.wait_for("drive", 12)
    page.mouse.up()
    stop = server.wait_for("stop")
    drives = server.heard("drive")
    assert stop["reason"] == "release"
    assert {(drive["linear"], drive["angular"]) for drive in drives} == {(0.3, 0.0)}
    gaps = [b["client_ms"] - a["client_ms"] for a, b in itertools.pairwise(drives)]
    assert 35 <= sorted(gaps)[len(gaps) // 2] <= 75
    assert all(drive["frame_id"] >= 1 for drive in drives)
    server.wait_for("ping", len(server.heard("ping")) + 1)
    assert len(server.heard("stop")) == 1 and drives_after_last_stop(server) == 0


def test_every_message_of_a_session_is_numbered_by_one(server, open_page):
    page = open_page()
    hold(page, LEFT)
    server.wait_for("drive", 5)
    page.mouse.up()
    server.wait_for("stop")
    seqs = [message["seq"] for message in list(server.received)]
    assert seqs == list(range(1, len(seqs) + 1))


@pytest.mark.parametrize(
    ("event", "reason"),
    [
        ("window.dispatchEvent(new Event('blur'))", "blur"),
        ("window.dispatchEvent(new PageTransitionEvent('pagehide'))", "pagehide"),
        ("(Object.defineProperty(document, 'hidden', {value: true, configurable: true}), "
         "document.dispatchEvent(new Event('visibilitychange')))", "hidden"),
    ],
)  # fmt: skip
def test_losing_the_operator_stops_with_its_reason_and_needs_a_new_press(server, open_page, event, reason):
    page = open_page()
    hold(page, FORWARD)
    server.wait_for("drive", 3)
    page.evaluate(event)
    server.wait_until(lambda: any(stop["reason"] == reason for stop in server.heard("stop")))
    count = len(server.heard("drive"))
    server.wait_for("ping", len(server.heard("ping")) + 1)
    assert len(server.heard("drive")) == count
    page.mouse.up()


@pytest.mark.parametrize("name", ["pointercancel", "lostpointercapture"])
def test_a_hold_that_is_taken_away_stops(server, open_page, name):
    page = open_page()
    hold(page, FORWARD)
    server.wait_for("drive", 2)
    page.evaluate(
        """name => document.querySelector('[data-drive=forward]')
             .dispatchEvent(new PointerEvent(name, {pointerId: 1, bubbles: true}))""",
        name,
    )
    assert server.wait_for("stop")["reason"] == "release"


def test_a_finger_that_slides_off_the_button_still_holds_it(server, open_page):
    page = open_page()
    hold(page, FORWARD)
    server.wait_for("drive", 2)
    page.mouse.move(500, 300)
    server.wait_for("drive", len(server.heard("drive")) + 4)
    assert server.heard("stop") == []
    page.mouse.up()
    server.wait_for("stop")
    assert server.heard("tap") == []


def test_two_keys_add_up_and_letting_one_go_is_no_stop(server, open_page):
    page = open_page()
    page.keyboard.down("w")
    page.keyboard.down("a")
    server.wait_until(lambda: server.heard("drive") and server.heard("drive")[-1]["angular"] > 0)
    both = server.heard("drive")[-1]
    assert (both["linear"], both["angular"]) == (0.3, 1.2)
    page.keyboard.up("w")
    server.wait_until(lambda: server.heard("drive")[-1]["linear"] == 0)
    assert server.heard("stop") == []
    page.keyboard.up("a")
    assert server.wait_for("stop")["reason"] == "release"


def test_opposite_keys_stand_still(server, open_page):
    page = open_page()
    page.keyboard.down("ArrowUp")
    page.keyboard.down("ArrowDown")
    server.wait_until(lambda: server.heard("drive") and server.heard("drive")[-1]["linear"] == 0)


def test_slow_pace_is_a_share_of_the_top_speed(server, open_page):
    page = open_page()
    page.click("#pace")
    page.keyboard.down("w")
    assert server.wait_for("drive")["linear"] == pytest.approx(0.35 * 0.3)


@pytest.mark.parametrize("press", ["Space", "Escape", "button"])
def test_stop_latches_cuts_a_hold_off_and_resume_unlatches(server, open_page, press):
    page = open_page()
    page.keyboard.down("w")
    server.wait_for("drive", 2)
    if press == "button":
        page.click("#stop")
    else:
        page.keyboard.press(press)
    server.wait_for("emergency_stop")
    page.wait_for_selector("#stopped:not([hidden])")
    count = len(server.heard("drive"))
    page.keyboard.up("w")
    page.keyboard.press("w")
    assert page.locator("#toast").inner_text() == "Stopped. Press Resume first."
    assert len(server.heard("drive")) == count
    page.click("#resume")
    server.wait_for("emergency_reset")
    wait_ready(page)
    page.keyboard.down("w")
    server.wait_for("drive", count + 1)


def test_stop_acts_on_the_way_down_and_once(server, open_page):
    page = open_page()
    hold(page, "#stop")
    server.wait_for("emergency_stop")
    page.mouse.up()
    server.wait_for("ping", len(server.heard("ping")) + 1)
    assert len(server.heard("emergency_stop")) == 1


def test_space_stops_although_a_button_has_the_focus(server, open_page):
    page = open_page()
    page.focus("#capture")
    page.keyboard.press("Space")
    server.wait_for("emergency_stop")
    server.wait_for("ping", len(server.heard("ping")) + 1)
    assert server.heard("capture") == []


def test_a_frozen_picture_is_shown_cuts_driving_off_and_refuses_it(server, open_page):
    server.frozen_after_ms = 500
    page = open_page()
    page.keyboard.down("w")
    server.wait_for("drive", 2)
    server.sends_frames = False
    page.wait_for_selector("#veil[data-kind=frozen]")
    assert page.locator("#veil-title").inner_text().startswith("FROZEN 0.")
    server.wait_for("stop")
    page.keyboard.up("w")
    count = len(server.heard("drive"))
    page.keyboard.press("w")
    assert "old. Driving waits" in page.locator("#toast").inner_text()
    assert len(server.heard("drive")) == count
    server.sends_frames = True
    wait_ready(page)
    assert page.locator("#veil").is_hidden()
    page.keyboard.down("w")
    server.wait_for("drive", count + 1)


def test_the_last_picture_names_itself_in_every_drive(server, open_page):
    page = open_page()
    page.keyboard.down("w")
    server.wait_for("drive", 10)
    page.keyboard.up("w")
    ids = [drive["frame_id"] for drive in server.heard("drive")]
    assert ids == sorted(ids) and ids[0] < ids[-1] <= server.acked[-1] + 1


def test_enter_on_a_focused_drive_button_is_a_hold(server, open_page):
    page = open_page()
    page.focus(FORWARD)
    page.keyboard.down("Enter")
    server.wait_for("drive", 2)
    page.keyboard.up("Enter")
    assert server.wait_for("stop")["reason"] == "release"


GAMEPAD = """pad => {
  const gamepad = pad && {mapping: 'standard', axes: pad.axes,
    buttons: [...Array(16).keys()].map(i => ({pressed: pad.down.includes(i)}))};
  navigator.getGamepads = () => [gamepad];
  if (gamepad && !window.padIsKnown) window.dispatchEvent(new Event('gamepadconnected'));
  window.padIsKnown = true;
}"""


def test_gamepad_drives_steps_and_stops(server, open_page):
    page = open_page()
    page.evaluate(GAMEPAD, {"axes": [0, -1], "down": []})
    assert server.wait_for("drive")["linear"] == 0.3
    page.evaluate(GAMEPAD, {"axes": [0, 0], "down": [5]})
    assert server.wait_for("stop")["reason"] == "release"
    assert server.wait_for("arm_step")["control"] == "T"
    page.evaluate(GAMEPAD, {"axes": [0, -1], "down": [1]})
    server.wait_for("emergency_stop")


def test_an_unplugged_gamepad_stops(server, open_page):
    page = open_page()
    page.evaluate(GAMEPAD, {"axes": [-1, 0], "down": []})
    assert server.wait_for("drive")["angular"] == 1.2
    page.evaluate(GAMEPAD, None)
    assert server.wait_for("stop")["reason"] == "release"


@pytest.mark.parametrize("control", ["T", "R", "left", "right", "forward", "backward"])
def test_each_arm_button_is_one_step_of_the_chosen_size(server, open_page, control):
    page = open_page()
    page.click("#step-open")
    page.click("#steps button:text-is('20°')")
    page.click(f"[data-arm={control}]")
    step = server.wait_for("arm_step")
    assert (step["control"], step["step_deg"]) == (control, 20)
    server.wait_for("ping", len(server.heard("ping")) + 1)
    assert len(server.heard("arm_step")) == 1


def test_holding_an_arm_key_repeats_until_release(server, open_page):
    page = open_page()
    page.keyboard.down("i")
    server.wait_for("arm_step", 4)
    page.keyboard.up("i")
    server.wait_for("ping", len(server.heard("ping")) + 1)
    count = len(server.heard("arm_step"))
    server.wait_for("ping", len(server.heard("ping")) + 1)
    assert len(server.heard("arm_step")) == count


@pytest.mark.parametrize("pose", ["standard", "stowed"])
def test_arm_poses(server, open_page, pose):
    page = open_page()
    page.click("#step-open")
    page.click(f"#pose-{pose}")
    assert server.wait_for("arm_goto")["pose"] == pose
