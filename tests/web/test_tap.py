"""A tap names the pixel under the finger in the very frame that was painted."""

import pytest

SIZES = {"tablet": (1024, 768), "phone": (390, 844), "short": (844, 390), "desktop": (1440, 900)}

# The spot on the screen whose picture pixel is (u, v), by the letterbox of a picture of `size`.
SPOT = """([u, v, width, height]) => {
  const box = document.getElementById('picture').getBoundingClientRect();
  const scale = Math.min(box.width / width, box.height / height);
  return [box.left + (box.width - width * scale) / 2 + (u + 0.5) * scale,
          box.top + (box.height - height * scale) / 2 + (v + 0.5) * scale, scale];
}"""

# Paints a frame, reads its id from the canvas pixels and taps, with nothing in between.
READ_ID_AND_TAP = """([x, y, bits, block, width, height]) => {
  const canvas = document.getElementById('picture');
  const box = canvas.getBoundingClientRect();
  const scale = Math.min(box.width / width, box.height / height);
  const left = (box.width - width * scale) / 2, top = (box.height - height * scale) / 2;
  const ratio = canvas.width / box.width;
  const at = bit => [(left + (bit + 0.5) * block * scale) * ratio, (top + block / 2 * scale) * ratio];
  const ctx = canvas.getContext('2d');
  let id = 0;
  for (let bit = 0; bit < bits; bit++) {
    if (ctx.getImageData(...at(bit).map(Math.round), 1, 1).data[0] > 127) id |= 1 << bit;
  }
  const how = {clientX: x, clientY: y, pointerId: 1, isPrimary: true, button: 0, bubbles: true};
  canvas.dispatchEvent(new PointerEvent('pointerdown', how));
  canvas.dispatchEvent(new PointerEvent('pointerup', how));
  return id;
}"""


@pytest.mark.parametrize("scale", [1, 2.625])
@pytest.mark.parametrize("layout", SIZES)
def test_tap_is_the_pixel_at_any_layout_and_density(server, open_page, layout, scale):
    page = open_page(SIZES[layout], scale)
    for count, (u, v) in enumerate([(320.0, 240.0), (400.0, 200.0), (250.0, 300.0)], start=1):
        x, y, shown = page.evaluate(SPOT, [u, v, *server.size])
        page.mouse.click(x, y)
        tap = server.wait_for("tap", count)
        # Chromium hands mouse positions over in single precision.
        assert (tap["u"], tap["v"]) == pytest.approx((u, v), abs=2e-3 / shown)


def test_tap_counts_in_camera_pixels_although_a_narrow_link_sends_fewer(server, open_page):
    server.background = server.background[::2, ::2].copy()
    page = open_page()
    x, y, _ = page.evaluate(SPOT, [400.0, 200.0, *server.size])
    page.mouse.click(x, y)
    tap = server.wait_for("tap")
    assert (tap["u"], tap["v"]) == pytest.approx((400.0, 200.0), abs=0.01)


def test_tap_names_the_painted_frame_a_hundred_times(server, open_page):
    page = open_page()
    x, y, _ = page.evaluate(SPOT, [320.0, 240.0, *server.size])
    painted = []
    for count in range(100):
        painted.append(page.evaluate(READ_ID_AND_TAP, [x, y, 16, 16, *server.size]))
        if count % 8 == 7:
            page.wait_for_function(f"document.getElementById('picture').dataset.frameId > {painted[-1]}")
    server.wait_for("tap", 100)
    assert [tap["frame_id"] for tap in server.heard("tap")] == painted
    assert len(set(painted)) > 10


def test_tap_beside_the_picture_says_nothing(server, open_page):
    page = open_page(SIZES["desktop"])
    page.mouse.click(160, 620)
    server.wait_for("ping", len(server.heard("ping")) + 1)
    assert server.heard("tap") == []


def test_a_finger_that_slides_is_no_tap(server, open_page):
    page = open_page()
    page.mouse.move(500, 400)
    page.mouse.down()
    page.mouse.move(560, 400, steps=4)
    page.mouse.up()
    server.wait_for("ping", len(server.heard("ping")) + 1)
    assert server.heard("tap") == []


def test_purpose_is_locate_until_floor_is_chosen(server, open_page):
    page = open_page()
    page.mouse.click(500, 400)
    assert server.wait_for("tap")["purpose"] == "locate"
    page.click("#purpose-floor")
    page.mouse.click(500, 400)
    assert server.wait_for("tap", 2)["purpose"] == "floor"


def test_a_tap_the_guide_waits_for_goes_to_the_guide(server, open_page):
    page = open_page()
    server.push(
        {"type": "guide", "kind": "two_tap", "step": 2, "steps": 6, "title": "Tap", "wants_tap": True}
    )
    page.wait_for_selector("#guide:not([hidden])")
    page.mouse.click(512, 400)
    assert server.wait_for("guide_tap")["frame_id"] >= 1
    assert server.heard("tap") == []


def test_a_refused_tap_says_why(server, open_page):
    page = open_page()
    server.tap_refusal = "frame 3 has expired: tap a newer picture"
    page.mouse.click(512, 400)
    page.wait_for_selector("#toast:not([hidden])")
    assert page.locator("#toast").inner_text() == "Frame 3 has expired: tap a newer picture"


def test_a_tap_on_a_scrubbed_picture_names_that_frame_and_locating_goes_live(server, open_page):
    page = open_page()
    server.wait_until(lambda: len(server.acked) > 45)
    page.click("#pause")
    page.wait_for_selector("#scrub:not([hidden])")
    newest = int(page.get_attribute("#picture", "data-frame-id"))
    page.locator("#scrub-slider").fill("-1")
    page.wait_for_function(f"document.getElementById('picture').dataset.frameId < {newest - 5}")
    x, y, _ = page.evaluate(SPOT, [320.0, 240.0, *server.size])
    painted = page.evaluate(READ_ID_AND_TAP, [x, y, 16, 16, *server.size])
    assert server.wait_for("tap")["frame_id"] == painted < newest - 5
    page.wait_for_selector("body:not(.is-paused)")


def test_the_video_flows_on_while_paused_and_live_shows_the_newest(server, open_page):
    page = open_page()
    page.keyboard.press("p")
    page.wait_for_selector("body.is-paused.cannot-drive")
    still = int(page.get_attribute("#picture", "data-frame-id"))
    server.wait_until(lambda: server.acked[-1] > still + 10)
    assert int(page.get_attribute("#picture", "data-frame-id")) == still
    page.click("#pause")
    page.wait_for_function(f"document.getElementById('picture').dataset.frameId > {still + 10}")


def test_driving_is_refused_while_paused(server, open_page):
    page = open_page()
    page.click("#pause")
    page.wait_for_selector("body.cannot-drive")
    page.keyboard.press("w")
    assert page.locator("#toast").inner_text() == "The picture is paused. Go live to drive."
    assert server.heard("drive") == []


def test_a_capture_of_a_paused_picture_names_its_frame(server, open_page):
    page = open_page()
    page.keyboard.press("c")
    assert server.wait_for("capture")["frame_id"] is None
    page.click("#pause")
    page.wait_for_selector("body.is-paused")
    page.click("#capture")
    assert server.wait_for("capture", 2)["frame_id"] == int(page.get_attribute("#picture", "data-frame-id"))


def test_every_frame_is_acknowledged_once_and_in_order(server, open_page):
    open_page()
    server.wait_until(lambda: len(server.acked) > 20)
    acked = list(server.acked)
    assert acked == list(range(acked[0], acked[0] + len(acked)))
