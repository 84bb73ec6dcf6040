"""Pure modules of the page, run in Chromium against known answers."""

import contextlib
from collections.abc import Callable, Iterator
from typing import Any

import pytest
from playwright.sync_api import Page
from tests.web.protocol_server import ProtocolServer
from tests.web.synthetic_video import video_message


@pytest.fixture(scope="module")
def run(browser) -> Iterator[Callable[..., Any]]:
    with ProtocolServer() as server, contextlib.closing(browser.new_page()) as page:
        page.goto(f"{server.url}style/icon.svg")
        yield runner(page)


def runner(page: Page) -> Callable[..., Any]:
    """Return a function that imports a module and runs `body` with it as `m`."""

    def run(path: str, body: str, argument: object = None) -> Any:
        code = f"async (given) => {{ const m = await import('/{path}'); {body} }}"
        return page.evaluate(code, argument)

    return run


@pytest.mark.parametrize("box", [(800.0, 600.0), (390.0, 700.0), (1001.0, 333.0)])
@pytest.mark.parametrize("pixel", [(0.0, 0.0), (639.0, 479.0), (100.25, 7.75)])
def test_placement_is_inverted_exactly_anywhere(run, box, pixel):
    body = """const p = m.placePicture(...given.box, 640, 480);
      const at = m.boxFromPicture(p, ...given.pixel);
      return [p, m.pictureFromBox(p, at.x, at.y)];"""
    placement, back = run("view/letterbox.js", body, {"box": box, "pixel": pixel})
    assert (back["u"], back["v"]) == pytest.approx(pixel, abs=1e-9)
    assert placement["width"] == pytest.approx(placement["height"] * 4 / 3)
    assert placement["left"] == pytest.approx((box[0] - placement["width"]) / 2)


def test_placement_puts_pixel_centres_half_a_pixel_in(run):
    corner = run("view/letterbox.js", "return m.pictureFromBox(m.placePicture(640, 480, 640, 480), 0, 0);")
    assert corner == {"u": -0.5, "v": -0.5}


def test_a_point_beside_the_picture_is_none(run):
    body = "const p = m.placePicture(1000, 480, 640, 480); return [m.pictureFromBox(p, 10, 10), p.left];"
    assert run("view/letterbox.js", body) == [None, 180]


def test_video_header_is_read_to_the_last_field(run):
    message = video_message(
        70_000, 1_234_567_890_123_456_789, b"\xff\xd8jpeg", (960, 720), [{"target_id": 3}]
    )
    body = """const f = m.parseVideoMessage(new Uint8Array(given).buffer, 5);
      return {...f, jpeg: Array.from(new Uint8Array(await f.jpeg.arrayBuffer())), type: f.jpeg.type};"""
    frame = run("net/video_message.js", body, list(message))
    assert frame["frameId"] == 70_000
    assert frame["capturedMs"] == pytest.approx(1_234_567_890_123.456, abs=1e-3)
    assert (frame["width"], frame["height"], frame["receivedMs"]) == (960, 720, 5)
    assert frame["meta"]["markers"] == [{"target_id": 3}]
    assert (bytes(frame["jpeg"]), frame["type"]) == (b"\xff\xd8jpeg", "image/jpeg")


@pytest.mark.parametrize("broken", [b"", b"TRV1", b"XXXX" + bytes(40), b"TRV1" + bytes(24) + b"\xff\xff\0\0"])
def test_a_broken_video_message_is_named(run, broken):
    body = """try { m.parseVideoMessage(new Uint8Array(given).buffer, 0); return ''; }
      catch (error) { return error.name; }"""
    assert run("net/video_message.js", body, list(broken)) == "RangeError"


def test_clock_offset_believes_the_shortest_round_trip(run):
    body = """const c = new m.ClockOffset();
      const before = [c.rttMs, c.ageMs(0, 0)];
      c.add(100, 1e6 * 5110, 120); c.add(200, 1e6 * 5204, 208); c.add(300, 1e6 * 5390, 400);
      return [before, c.rttMs, c.offsetMs, c.ageMs(5000, 150), c.ageMs(9000, 150)];"""
    assert run("net/clock_offset.js", body) == [[None, None], 100, 5000, 150, 0]


def test_clock_offset_forgets_a_server_that_was_started_anew(run):
    body = "const c = new m.ClockOffset(); c.add(1, 1, 2); c.reset(); return c.offsetMs;"
    assert run("net/clock_offset.js", body) is None


def test_ring_keeps_ten_seconds_and_finds_the_nearest(run):
    body = """const ring = new m.FrameRing();
      for (let i = 0; i <= 600; i++) ring.push({frameId: i, capturedMs: i * 33});
      const kept = ring.snapshot();
      return [kept[0].capturedMs >= 600 * 33 - 10000, kept.length,
        m.frameAt(kept, 0).frameId, m.frameAt(kept, 1000).frameId,
        m.frameAt(kept, 1e9).frameId === kept[0].frameId,
        m.frameAt([], 0)];"""
    assert run("view/frame_ring.js", body) == [True, 304, 600, 570, True, None]


def test_ring_starts_anew_when_time_runs_back(run):
    body = """const ring = new m.FrameRing();
      ring.push({capturedMs: 9000}); ring.push({capturedMs: 10}); return ring.frames.length;"""
    assert run("view/frame_ring.js", body) == 1


def test_heartbeat_needs_a_young_token(run):
    body = """const h = new m.Heartbeat(); const out = [h.beat(0)];
      h.feed({atMs: 1000, frameId: 7});
      out.push(h.beat(1100), h.beat(1100.5)); h.feed(null); out.push(h.beat(1000)); return out;"""
    beat = {"type": "heartbeat", "client_ms": 1000, "frame_id": 7}
    assert run("net/heartbeat.js", body) == [None, beat, None, None]


@pytest.mark.parametrize(
    ("twist", "words", "angle"),
    [
        ((0.0, 0.0), "Still", None),
        ((0.12, 0.0), "Forward 0.12 m/s", 0),
        ((-0.05, 0.0), "Back 0.05 m/s", 180),
        ((0.0, 0.5), "Left 29°/s", -90),
        ((0.1, -0.2), "Forward 0.10 m/s, right 11°/s", 45),
    ],
)
def test_motion_in_words_and_arrow(run, twist, words, angle):
    text, turn = run("view/words.js", "return [m.motion(...given), m.arrow(...given)];", twist)
    assert (text, turn) == (words, angle if angle is None else pytest.approx(angle))


def test_numbers_have_a_true_minus_and_no_negative_zero(run):
    body = "return [m.number(-0.001, 2), m.number(-1.5, 1), m.length(0.944), m.length(-2), m.duration(1234)];"
    assert run("view/words.js", body) == ["0.00", "\u22121.5", "94.4 cm", "\u22122.00 m", "1.2 s"]


def test_plan_turns_world_into_base(run):
    odometry = {"x": 1.0, "y": 2.0, "heading_deg": 90.0}
    point = run("view/plan.js", "return m.baseFromWorld(given, 1, 5);", odometry)
    assert (point["x"], point["y"]) == pytest.approx((3.0, 0.0), abs=1e-12)
    left = run("view/plan.js", "return m.baseFromWorld(given, 0, 2);", odometry)
    assert (left["x"], left["y"]) == pytest.approx((0.0, 1.0), abs=1e-12)


@pytest.mark.parametrize(("most", "shown"), [(0.99, 0.5), (1.0, 1.0), (4.9, 2.0), (0.07, 0.05)])
def test_scale_bar_is_a_round_length(run, most, shown):
    assert run("view/plan.js", "return m.roundLength(given);", most) == pytest.approx(shown)


def test_stick_is_continuous_at_the_dead_zone(run):
    body = "return [0.1, 0.15, 0.151, -1, 1].map(m.withDeadZone);"
    rest, edge, above, least, most = run("input/gamepad.js", body)
    assert (rest, edge, least, most) == (0, 0, -1, 1)
    assert 0 < above < 0.01


def test_device_names_tell_tablets_from_phones(run):
    agents = ["X (iPad; CPU)", "X (Linux; Android 14) Mobile", "X (Linux; Android 14)", "X (X11; Linux)", "?"]
    names = run("net/device_name.js", "return given.map(m.deviceName);", agents)
    assert names == ["iPad", "Android phone", "Android tablet", "Linux PC", "Browser"]
