"""Every screen in every state: nothing scrolls or overlaps; all is large enough, named and legible."""

import re
from itertools import combinations

import pytest
from tests.web.protocol_server import WEB
from tests.web.test_box import EXTENT
from tests.web.test_panels import GUIDE, MARKER, TARGET

SCREENS = [(1024, 768), (1180, 820), (390, 844), (844, 390), (1440, 900)]
LONG = (
    "Turn the robot left by 10 to 15 degrees about its own axis. The target moves right of the centre line."
)
LEAST_PX = 48
CHANGE = """--- rover.toml
+++ rover.toml
@@ -61,2 +61,2 @@ [arm.servos.shoulder]
-low_us = 720
+low_us = 680
@@ -64 +64 @@ [arm.servos.shoulder]
-pulse_at_zero_us = 1500
+pulse_at_zero_us = 1470"""

# Controls a finger can reach now: in their own scroller's window, and not under something else.
CONTROLS = """() => [...document.querySelectorAll('button, a[href], input')].flatMap(element => {
  const box = element.getBoundingClientRect();
  if (!box.width || !element.checkVisibility()) return [];
  const scroller = element.closest('.guide__body, .thumbs, .card__numbers');
  const view = scroller ? scroller.getBoundingClientRect() : {top: 0, bottom: innerHeight};
  if (scroller && (box.top < view.top - 1 || box.bottom > view.bottom + 1)) return [];
  const hit = document.elementFromPoint(box.left + box.width / 2, box.top + box.height / 2);
  const labels = [...(element.labels ?? [])].map(label => label.textContent);
  return [{name: (element.getAttribute('aria-label') || labels.join() || element.textContent).trim(),
    id: element.id || element.className, left: box.left, top: box.top, right: box.right, bottom: box.bottom,
    isHit: element === hit || element.contains(hit), layer: element.closest('.popover, .sheet')?.id ?? ''}];
})"""


def nothing(_page, _server):
    """Leave the page as it is."""


def with_target(page, server):
    server.markers = [MARKER | {"region": []}]
    cut = "cut off at the picture's left and lower edge: at least so large"
    server.push(TARGET | {"extent": EXTENT | {"reason": cut}})
    page.wait_for_selector("#card:not([hidden])")


def with_task(page, server):
    with_target(page, server)
    task = {"type": "task", "task_id": 1, "kind": "locate", "state": "running", "phase": "advancing"}
    server.push(task | {"progress": 0.5, "message": "11 cm of 20 cm"})
    server.change(sent={"linear": 0.12, "angular": 0.21}, limited_by="the picture is too old")
    page.wait_for_selector("#task:not([hidden])")


def with_guide(page, server):
    acts = {"acts": ["turn", "next", "back"], "theta_deg": 8.2, "hint": "Turned 8.2° so far: a little more."}
    server.push(GUIDE | acts | {"instruction": LONG})
    page.wait_for_selector("#guide:not([hidden])")


def with_captures(page, server):
    server.captures = [
        {"id": f"c{i}", "taken_at": "2026-01-31T12:00:01", "width": 640, "height": 480, "frame_id": i}
        for i in range(9)
    ]
    server.push({"type": "captures_changed", "newest": "c8"})
    page.wait_for_function("document.querySelectorAll('.thumb').length === 9")
    page.click("#captures-open")


def with_steps(page, _server):
    page.click("#step-open")


def with_menu(page, _server):
    page.click("#menu-open")


def with_keys(page, _server):
    page.click("#menu-open")
    page.click("#menu-keys")


def paused(page, _server):
    page.click("#pause")
    page.wait_for_selector("body.is-paused")


def stopped(page, server):
    page.keyboard.press("Space")
    page.wait_for_selector("#stopped:not([hidden])")


def frozen(page, server):
    server.capture_delay_ns = 6_000_000_000
    page.wait_for_selector("#veil[data-kind=frozen]")


def disconnected(page, server):
    server.refuses = True
    server.drop_sockets()
    page.wait_for_selector("#veil:not([hidden])")


def asked(page, server):
    server.change(lease=server.state["lease"] | {"asked_by_id": 9, "asked_by_name": "Android tablet"})
    page.wait_for_selector("#asked:not([hidden])")


def hinted(page, _server):
    page.click("#menu-open")
    page.click("#menu-hints")


def with_lessons(page, server):
    server.lessons = ("motors", "encoders", "servos")
    page.reload()
    page.click("#menu-open")
    page.click("#menu-lessons")


def with_jog(page, server):
    said = "Go by steps until the arm points straight ahead; a servo that hums presses against something."
    asked = {"question_id": 5, "question": "1450 µs", "answers": ["-", "+", "--", "++", "ok"]}
    server.push({"type": "lesson", "lesson": "servos", "said": [said]} | asked)
    page.wait_for_selector("#lesson-acts button:not([disabled])")


def with_change(page, server):
    asked = {"question_id": 6, "question": "Write this?", "answers": ["yes", "no"]}
    server.push({"type": "lesson", "lesson": "servos", "change": CHANGE} | asked)
    page.wait_for_selector("#lesson-change:not([hidden])")


STATES = [
    nothing, with_target, with_task, with_guide, with_lessons, with_jog, with_change, with_captures,
    with_steps, with_menu, with_keys, paused, stopped, frozen, disconnected, asked, hinted,
]  # fmt: skip


def overlap(a, b):
    """Tell whether two controls lie over each other; an open menu may cover what is not STOP."""
    if a["layer"] != b["layer"] and "stop" not in (a["id"], b["id"]):
        return False
    width = min(a["right"], b["right"]) - max(a["left"], b["left"])
    return width > 1 and min(a["bottom"], b["bottom"]) - max(a["top"], b["top"]) > 1


@pytest.mark.parametrize("state", STATES, ids=lambda state: state.__name__)
def test_a_state_fits_every_screen(server, open_page, state):
    page = open_page(SCREENS[0])
    state(page, server)
    complaints = []
    for width, height in SCREENS:
        page.set_viewport_size({"width": width, "height": height})
        page.evaluate("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")
        complaints += [(width, height, *complaint) for complaint in complaints_about(page, (width, height))]
    assert complaints == []


def complaints_about(page, screen):
    """Return what is wrong with the screen, as tuples that begin with the kind of trouble."""
    size = page.evaluate("[document.documentElement.scrollWidth, document.documentElement.scrollHeight]")
    controls = page.evaluate(CONTROLS)
    reachable = [control for control in controls if control["isHit"]]
    if size[0] > screen[0] or size[1] > screen[1]:
        yield "scrolls", *size
    if "stop" not in [control["id"] for control in reachable]:
        yield "STOP is not in reach", None
    yield from (("has no name", control["id"]) for control in controls if not control["name"])
    for control in reachable:
        width, height = control["right"] - control["left"], control["bottom"] - control["top"]
        if min(width, height) < LEAST_PX - 0.5:
            yield "is small", control["id"], width, height
        if control["right"] > screen[0] + 1 or control["bottom"] > screen[1] + 1:
            yield "is outside", control["id"]
    yield from (("overlap", a["id"], b["id"]) for a, b in combinations(reachable, 2) if overlap(a, b))


@pytest.mark.parametrize("screen", SCREENS, ids=lambda size: f"{size[0]}x{size[1]}")
def test_the_guide_leaves_the_pictures_centre_free(server, open_page, screen):
    page = open_page(screen)
    with_guide(page, server)
    canvas = page.locator("#picture").bounding_box()
    guide = page.locator("#guide").bounding_box()
    x, y = canvas["x"] + canvas["width"] / 2, canvas["y"] + canvas["height"] / 2
    inside = (
        guide["x"] <= x <= guide["x"] + guide["width"] and guide["y"] <= y <= guide["y"] + guide["height"]
    )
    assert not inside
    assert page.evaluate("([x, y]) => document.elementFromPoint(x, y).id", [x, y]) == "picture"
    acts = page.locator("#guide-acts").bounding_box()
    assert acts["y"] + acts["height"] <= guide["y"] + guide["height"] + 1


TEXTS = """() => [...document.querySelectorAll('body *')].flatMap(element => {
  const own = [...element.childNodes].some(node => node.nodeType === 3 && node.textContent.trim());
  if (!own || !element.checkVisibility() || element.closest('noscript, svg')) return [];
  const opaque = []; let node = element;
  for (; node; node = node.parentElement) opaque.push(getComputedStyle(node).backgroundColor);
  return [{text: element.textContent.trim(), colour: getComputedStyle(element).color, backgrounds: opaque,
    size: parseFloat(getComputedStyle(element).fontSize)}];
})"""


def colour(text):
    """Return red, green, blue 0..1 and alpha."""
    parts = [float(part) for part in re.findall(r"[\d.]+", text)]
    return [value / 255 for value in parts[:3]], parts[3] if len(parts) > 3 else 1.0


def luminance(rgb):
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in rgb]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def contrast(text, backgrounds, behind):
    """Return the WCAG contrast of a text with its stack of backgrounds laid over `behind`."""
    ground = behind
    for layer in reversed(backgrounds):
        rgb, alpha = colour(layer)
        ground = [alpha * top + (1 - alpha) * below for top, below in zip(rgb, ground, strict=True)]
    light, dark = sorted((luminance(colour(text)[0]), luminance(ground)), reverse=True)
    return (light + 0.05) / (dark + 0.05)


@pytest.mark.parametrize(
    "state", [with_task, with_guide, with_jog, with_change, with_captures, stopped, with_keys]
)
def test_text_reads_at_wcag_aa_over_a_dark_room(server, open_page, state):
    page = open_page()
    state(page, server)
    weak = [
        (text["text"], round(contrast(text["colour"], text["backgrounds"], [0.25, 0.2, 0.15]), 2))
        for text in page.evaluate(TEXTS)
        if contrast(text["colour"], text["backgrounds"], [0.25, 0.2, 0.15]) < 4.5
    ]
    assert weak == []


def test_no_text_is_smaller_than_12_px(server, open_page):
    page = open_page()
    with_task(page, server)
    assert min(text["size"] for text in page.evaluate(TEXTS)) >= 12


def test_focus_is_visible(server, open_page):
    page = open_page()
    page.keyboard.press("Tab")
    outline = page.evaluate("getComputedStyle(document.activeElement).outline")
    assert "solid" in outline and not outline.endswith(" 0px")


def test_reduced_motion_moves_nothing(server, open_page):
    page = open_page()
    page.click("#menu-open")
    assert page.evaluate("document.getAnimations().length") == 0


def test_every_live_message_has_a_live_region(server, open_page):
    page = open_page()
    for name in ("toast", "veil", "stopped", "link-text", "lease-who"):
        assert page.get_attribute(f"#{name}", "role") in ("status", "alert"), name


def test_every_id_the_code_asks_for_is_in_the_page():
    html = (WEB / "index.html").read_text()
    code = "".join(path.read_text() for path in WEB.rglob("*.js"))
    asked = set(re.findall(r'byId\("([^"]+)"\)', code))
    assert sorted(asked - set(re.findall(r'id="([^"]+)"', html))) == []
    assert len(asked) > 50
