"""A box drawn around a thing: what the page sends, draws and drops, by mouse, finger and pen."""

import pytest
from tests.web.test_panels import MARKER, TARGET
from tests.web.test_tap import SIZES, SPOT

# Light blue-white as boxes are drawn, inside a part of the canvas [CSS px].
INKED = """([x, y, width, height]) => { const c = document.getElementById('picture');
  const at = c.getBoundingClientRect(), ratio = c.width / at.width;
  const d = c.getContext('2d').getImageData((x - at.left) * ratio, (y - at.top) * ratio,
    Math.max(1, width * ratio), Math.max(1, height * ratio)).data;
  let n = 0; for (let i = 0; i < d.length; i += 4) if (d[i] > 225 && d[i+1] > 225 && d[i+2] > 225) n++;
  return n; }"""
POINTER = """([kind, type, x, y, id, primary]) => document.getElementById('picture').dispatchEvent(
  new PointerEvent(kind, {clientX: x, clientY: y, pointerId: id, isPrimary: primary, pointerType: type,
    button: kind === 'pointermove' ? -1 : 0, buttons: kind === 'pointerup' ? 0 : 1, bubbles: true}))"""
EXTENT = {
    "width": 0.0713,
    "height": 0.1184,
    "width_sigma": 0.0052,
    "height_sigma": 0.0031,
    "reason": "",
}


def spot(page, server, u: float, v: float) -> tuple[float, float]:
    x, y, _ = page.evaluate(SPOT, [u, v, *server.size])
    return x, y


def drag(page, start, *ways, up: bool = True) -> None:
    page.mouse.move(*start)
    page.mouse.down()
    for way in ways:
        page.mouse.move(*way, steps=3)
    if up:
        page.mouse.up()


def heard_nothing(server) -> None:
    """After a whole round of another message nothing of a tap or box was heard."""
    server.wait_for("ping", len(server.heard("ping")) + 1)
    assert server.heard("tap") == []


@pytest.mark.parametrize("scale", [1, 2.625])
@pytest.mark.parametrize("layout", SIZES)
def test_box_is_what_was_drawn_at_any_layout_and_density(server, open_page, layout, scale):
    page = open_page(SIZES[layout], scale)
    drag(page, spot(page, server, 360.0, 130.0), spot(page, server, 470.0, 250.0))
    message = server.wait_for("tap")
    shown = page.evaluate(SPOT, [0.0, 0.0, *server.size])[2]
    assert message["box"] == pytest.approx([360.0, 130.0, 470.0, 250.0], abs=2e-3 / shown)
    assert (message["u"], message["v"]) == pytest.approx((415.0, 190.0), abs=2e-3 / shown)
    assert message["purpose"] == "locate"


def test_box_drawn_from_any_corner_is_the_same(server, open_page):
    page = open_page()
    drag(page, spot(page, server, 470.0, 130.0), spot(page, server, 360.0, 250.0))
    assert server.wait_for("tap")["box"] == pytest.approx([360.0, 130.0, 470.0, 250.0], abs=0.01)


def test_box_names_the_frame_that_is_painted_when_the_finger_lifts(server, open_page):
    page = open_page()
    drag(page, spot(page, server, 360.0, 130.0), spot(page, server, 470.0, 250.0), up=False)
    begun = int(page.get_attribute("#picture", "data-frame-id"))
    page.wait_for_function(f"document.getElementById('picture').dataset.frameId > {begun + 5}")
    server.sends_frames = False
    server.wait_until(lambda: server.acked[-1] == server._frame_id)
    last = int(page.get_attribute("#picture", "data-frame-id"))
    page.mouse.up()
    assert server.wait_for("tap")["frame_id"] == last


def test_floor_guess_takes_a_box_too(server, open_page):
    page = open_page()
    page.click("#purpose-floor")
    drag(page, spot(page, server, 360.0, 130.0), spot(page, server, 470.0, 250.0))
    message = server.wait_for("tap")
    assert message["purpose"] == "floor"
    assert len(message["box"]) == 4


def test_finger_draws_a_box_as_the_mouse_does(server, open_page):
    page = open_page(SIZES["phone"])
    (x, y), (right, bottom) = spot(page, server, 360.0, 230.0), spot(page, server, 470.0, 350.0)
    browser = page.context.new_cdp_session(page)
    browser.send("Emulation.setTouchEmulationEnabled", {"enabled": True})
    for kind, *place in (("Start", x, y), ("Move", x + 30, y + 25), ("Move", right, bottom), ("End",)):
        points = [{"x": place[0], "y": place[1]}] if place else []
        browser.send("Input.dispatchTouchEvent", {"type": f"touch{kind}", "touchPoints": points})
    assert server.wait_for("tap")["box"] == pytest.approx([360.0, 230.0, 470.0, 350.0], abs=1.0)


def test_pen_draws_a_box_as_the_mouse_does(server, open_page):
    page = open_page()
    (x, y), (right, bottom) = spot(page, server, 360.0, 130.0), spot(page, server, 470.0, 250.0)
    for name, place in (("down", (x, y)), ("move", (x + 40, y + 30)), ("move", (right, bottom))):
        page.evaluate(POINTER, [f"pointer{name}", "pen", *place, 5, True])
    page.evaluate(POINTER, ["pointerup", "pen", right, bottom, 5, True])
    assert server.wait_for("tap")["box"] == pytest.approx([360.0, 130.0, 470.0, 250.0], abs=0.01)


def test_box_is_drawn_while_it_is_dragged(server, open_page):
    page = open_page()
    (x, y), (right, bottom) = spot(page, server, 100.0, 200.0), spot(page, server, 220.0, 320.0)
    edge = [right - 3, y + 20, 6, bottom - y - 40]
    before = page.evaluate(INKED, edge)
    drag(page, (x, y), (right, bottom), up=False)
    page.wait_for_function(f"(edge) => ({INKED})(edge) > {before + 60}", arg=edge)
    page.mouse.move(x + 5, y + 5, steps=2)
    page.wait_for_function(f"(edge) => ({INKED})(edge) <= {before + 5}", arg=edge)


def test_box_reaches_no_farther_than_the_picture(server, open_page):
    page = open_page((1440, 900))
    start, corner = spot(page, server, 500.0, 300.0), spot(page, server, 639.5, 479.5)
    drag(page, start, (corner[0] + 60, corner[1] - 40), (corner[0] + 120, corner[1] + 30))
    assert server.wait_for("tap")["box"] == pytest.approx([500.0, 300.0, 639.5, 479.5], abs=0.01)


@pytest.mark.parametrize("way", [(90, 0), (0, 90), (90, 14), (12, 80)])
def test_slide_along_one_line_is_neither_tap_nor_box(server, open_page, way):
    page = open_page()
    x, y = spot(page, server, 300.0, 200.0)
    drag(page, (x, y), (x + way[0], y + way[1]))
    heard_nothing(server)


def test_slide_that_comes_back_is_no_tap(server, open_page):
    page = open_page()
    x, y = spot(page, server, 300.0, 200.0)
    drag(page, (x, y), (x + 60, y), (x, y))
    heard_nothing(server)


def test_dragging_back_drops_the_box(server, open_page):
    page = open_page()
    x, y = spot(page, server, 300.0, 200.0)
    drag(page, (x, y), (x + 90, y + 90), (x + 6, y + 6))
    heard_nothing(server)


def test_escape_drops_the_box_and_stops_the_robot(server, open_page):
    page = open_page()
    x, y = spot(page, server, 300.0, 200.0)
    drag(page, (x, y), (x + 90, y + 90), up=False)
    page.keyboard.press("Escape")
    page.mouse.up()
    server.wait_for("emergency_stop")
    heard_nothing(server)


def test_second_mouse_button_drops_the_box(server, open_page):
    page = open_page()
    x, y = spot(page, server, 300.0, 200.0)
    drag(page, (x, y), (x + 90, y + 90), up=False)
    page.mouse.down(button="right")
    page.mouse.up(button="right")
    page.mouse.up()
    heard_nothing(server)


def test_second_finger_drops_the_box(server, open_page):
    page = open_page()
    x, y = spot(page, server, 300.0, 200.0)
    page.evaluate(POINTER, ["pointerdown", "touch", x, y, 5, True])
    page.evaluate(POINTER, ["pointermove", "touch", x + 90, y + 90, 5, True])
    page.evaluate(POINTER, ["pointerdown", "touch", x + 200, y, 6, False])
    page.evaluate(POINTER, ["pointerup", "touch", x + 90, y + 90, 5, True])
    heard_nothing(server)


def test_box_drawn_while_the_robot_moves_is_refused_with_the_reason(server, open_page):
    page = open_page()
    x, y = spot(page, server, 300.0, 200.0)
    drag(page, (x, y), (x + 90, y + 90), up=False)
    server.base, seen = (0.3, 0.0, 0.1), server.acked[-1]
    server.wait_until(lambda: server.acked[-1] > seen + 3)
    page.mouse.up()
    page.wait_for_selector("#toast:not([hidden])")
    assert "robot moved while you drew" in page.locator("#toast").inner_text()
    heard_nothing(server)


def test_guide_that_waits_for_a_tap_takes_no_box(server, open_page):
    page = open_page()
    guide = {"type": "guide", "kind": "two_tap", "step": 2, "steps": 6, "title": "Tap", "wants_tap": True}
    server.push(guide)
    page.wait_for_selector("#guide:not([hidden])")
    x, y = spot(page, server, 420.0, 200.0)
    drag(page, (x, y), (x + 90, y + 90))
    heard_nothing(server)
    assert server.heard("guide_tap") == []


def test_card_tells_the_size_with_95_percent_and_what_to_know_of_it(server, open_page):
    page = open_page()
    server.push(TARGET | {"extent": EXTENT})
    page.wait_for_selector("#card-size:text-is('7 cm wide ± 1, 11.8 cm high ± 0.6')")
    cut = "cut off at the picture's left edge: at least so large"
    server.push(TARGET | {"extent": EXTENT | {"reason": cut}})
    page.wait_for_selector("#card-size:text('. Cut off at the picture')")
    nothing = dict.fromkeys(("width", "height", "width_sigma", "height_sigma"))
    server.push(TARGET | {"extent": EXTENT | nothing | {"reason": "the thing is straight below"}})
    page.wait_for_selector("#card-size:text-is('No size: the thing is straight below')")
    server.push(TARGET | {"extent": None})
    page.wait_for_selector("#card-size:text-is('')", state="attached")


def test_box_of_the_size_is_drawn_where_the_frame_says(server, open_page):
    page = open_page()
    cyan = """([x, y]) => { const c = document.getElementById('picture'), at = c.getBoundingClientRect();
      const d = c.getContext('2d').getImageData(x - at.left - 4, y - at.top - 4, 9, 9).data;
      for (let i = 0; i < d.length; i += 4) if (d[i] < 130 && d[i+1] > 180 && d[i+2] > 220) return true;
      return false; }"""
    for left in (100.0, 300.0):
        box = [[left, 200.0], [left + 90.0, 200.0], [left + 90.0, 330.0], [left, 330.0]]
        server.markers = [MARKER | {"u": left + 45.0, "v": 260.0, "region": [], "box": box}]
        server.push(TARGET | {"extent": EXTENT, "frame_id": 1})
        for u, v in box:
            page.wait_for_function(f"(spot) => ({cyan})(spot)", arg=list(spot(page, server, u, v)))
