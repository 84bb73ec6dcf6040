"""Target card, task panel, guide, captures, hints, menus."""

import pytest

TARGET = {
    "type": "target",
    "target_id": 1,
    "source": "locate",
    "status": "ok",
    "reason": "",
    "advice": "Drive 12 cm more to halve the error.",
    "frame_id": 1,
    "u": 180.0,
    "v": 120.0,
    "point_in_base": [0.92, 0.21, 0.06],
    "point_in_world": [1.16, 0.38, 0.06],
    "sigma": [0.021, 0.006, 0.004],
    "range": 0.944,
    "range_low": 0.905,
    "range_high": 0.986,
    "region_in_world": [[1.1, 0.3], [1.2, 0.3], [1.2, 0.4]],
    "rays_in_world": [[0.31, -0.02, 0.9, 0.43]],
    "is_following": True,
}
MARKER = {"target_id": 1, "u": 180.0, "v": 122.0, "inside": True, "state": "followed"}
GUIDE = {
    "type": "guide",
    "kind": "two_tap",
    "step": 4,
    "steps": 6,
    "title": "Turn left",
    "acts": ["turn", "next"],
}
CYAN = """() => { const c = document.getElementById('picture'); const d = c.getContext('2d')
  .getImageData(0, 0, c.width, c.height).data; let n = 0, x = 0, y = 0;
  for (let i = 0; i < d.length; i += 4) if (d[i] < 130 && d[i+1] > 180 && d[i+2] > 220) {
    n++; x += (i / 4) % c.width; y += Math.floor(i / 4 / c.width); }
  return [n, n && x / n, n && y / n]; }"""


def test_the_card_shows_distance_and_coordinates_with_95_percent(server, open_page):
    page = open_page()
    server.push(TARGET)
    page.wait_for_selector("#card:not([hidden])")
    assert page.locator("#card-range").inner_text() == "94.4 cm"
    assert page.locator("#card-interval").inner_text() == "95 %: 90.5 cm to 98.6 cm"
    cells = page.locator("#card-xyz > *").all_inner_texts()
    assert cells == ["X", "92.0 cm", "± 4.1", "Y", "21.0 cm", "± 1.2", "Z", "6.0 cm", "± 0.8"]
    assert page.locator("#card-advice").inner_text() == TARGET["advice"]


def test_no_answer_is_a_card_with_its_reason(server, open_page):
    page = open_page()
    nothing = dict.fromkeys(("point_in_base", "point_in_world", "sigma", "range", "range_low", "range_high"))
    server.push(TARGET | nothing | {"status": "no_parallax", "reason": "Too little parallax."})
    page.wait_for_selector("#card:not([hidden])")
    assert page.locator("#card-range").inner_text() == "No position"
    assert page.locator("#card-reason").inner_text() == "Too little parallax."
    assert page.locator("#card-xyz > *").count() == 0


def test_an_open_interval_says_beyond(server, open_page):
    page = open_page()
    server.push(TARGET | {"range_high": None})
    page.wait_for_selector("#card-interval:text-is('95 %: beyond 90.5 cm')")


def test_closing_the_card_forgets_the_target(server, open_page):
    page = open_page()
    server.push(TARGET)
    page.click("#card-close")
    assert server.wait_for("target_clear")["target_id"] == 1
    server.push({"type": "target_gone", "target_id": 1})
    page.wait_for_selector("#card", state="hidden")


def test_the_marker_stands_where_the_frames_meta_puts_it(server, open_page):
    page = open_page()
    assert page.evaluate(CYAN)[0] == 0
    server.push(TARGET)
    centres = []
    for u in (180.0, 420.0):
        server.markers = [
            MARKER | {"u": u, "region": [[u - 20, 90], [u + 20, 90], [u + 20, 150], [u - 20, 150]]}
        ]
        seen = len(server.acked)
        server.wait_until(lambda seen=seen: len(server.acked) > seen + 3)
        count, x, _ = page.evaluate(CYAN)
        assert count > 100
        centres.append(x)
    box = page.locator("#picture").bounding_box()
    scale = min(box["width"] / 640, box["height"] / 480)
    assert centres[1] - centres[0] == pytest.approx(240 * scale, abs=4)


def test_the_plan_is_drawn(server, open_page):
    page = open_page()
    server.push(TARGET)
    page.wait_for_function("""() => { const c = document.getElementById('plan'); if (!c.width) return false;
      const d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data;
      return d.some((value, index) => index % 4 === 3 && value === 255); }""")


def test_card_turns_over_to_the_plan_where_there_is_room_for_one_side(server, open_page):
    page = open_page(size=(844, 390), scale=2)
    server.push(TARGET)
    page.click("#card-flip")
    page.wait_for_function(f"({GREEN})('plan') === 0")
    server.push(MOVE)
    page.wait_for_function(f"({GREEN})('plan') > 100")
    height = page.locator("#plan").bounding_box()["height"]
    assert 60 < height < 200
    server.push(NO_MOVE)
    page.wait_for_function(f"({GREEN})('plan') === 0")
    assert page.locator("#plan").bounding_box()["height"] == height


def test_a_task_shows_phase_and_progress_and_can_be_cancelled(server, open_page):
    page = open_page()
    task = {"type": "task", "task_id": 1, "kind": "locate", "state": "running", "phase": "turning_left"}
    server.push(task | {"progress": 0.25, "message": "5° of 12°"})
    page.wait_for_selector("#task:not([hidden])")
    assert page.locator("#task-phase").inner_text() == "Turning left"
    assert page.evaluate("document.getElementById('task-progress').value") == 0.25
    page.click("#task-cancel")
    server.wait_for("task_cancel")
    server.push(task | {"state": "failed", "progress": 0.3, "message": "the target was lost"})
    page.wait_for_selector("#task", state="hidden")
    assert page.locator("#toast").inner_text() == "The target was lost"


MOVE = {
    "type": "move",
    "tracks_in_world": [[[0.3, 0.08], [0.6, 0.1]], [[0.3, -0.12], [0.6, -0.1]]],
    "body_in_world": [[0.55, 0.1], [0.75, 0.1], [0.75, -0.1], [0.55, -0.1]],
    "words": "driving 0.30 m forward",
    "expected_sd": 0.0213,
    "expected_relative_sd": 0.0142,
}
NO_MOVE = MOVE | {
    "tracks_in_world": [],
    "body_in_world": [],
    "words": "",
    "expected_sd": None,
    "expected_relative_sd": None,
}
GREEN = """(id) => { const c = document.getElementById(id); if (!c.width) return 0;
  const d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data; let n = 0;
  for (let i = 0; i < d.length; i += 4)
    if (d[i] < 140 && d[i + 1] > 190 && d[i + 2] > 120 && d[i + 2] < 190) n++;
  return n; }"""


def test_move_is_shown_with_what_it_should_bring_until_it_is_over(server, open_page):
    page = open_page()
    server.push(TARGET)
    task = {"type": "task", "task_id": 1, "kind": "locate", "state": "running", "phase": "move"}
    server.push(task | {"progress": 0.25, "message": "driving 0.30 m forward"})
    server.push(MOVE)
    page.wait_for_selector("#task-expects:not([hidden])")
    assert page.locator("#task-expects").inner_text() == "expects ±2.1 cm, 1.4 %"
    page.wait_for_function(f"({GREEN})('plan') > 100")
    server.push(NO_MOVE)
    page.wait_for_selector("#task-expects", state="hidden")
    page.wait_for_function(f"({GREEN})('plan') === 0")


def test_how_far_a_move_of_the_robots_own_is_stands_with_the_task_while_it_lasts(server, open_page):
    page = open_page()
    task = {"type": "task", "task_id": 1, "kind": "locate", "state": "running", "phase": "move"}
    server.push(task | {"progress": 0.25, "message": "driving 0.30 m forward"})
    page.wait_for_selector("#task:not([hidden])")
    assert page.locator("#task-move").is_hidden()
    server.change(own_move=0.437)
    page.wait_for_selector("#task-move:text-is('43 % of this move')")
    server.change(own_move=None)
    page.wait_for_selector("#task-move", state="hidden")


def test_path_is_drawn_where_the_frames_meta_puts_it(server, open_page):
    page = open_page()
    assert page.evaluate(GREEN, "picture") == 0
    server.path = [
        [[200.0, 470.0], [260.0, 300.0]],
        [[440.0, 470.0], [380.0, 300.0]],
        [[270.0, 260.0], [370.0, 260.0], [390.0, 320.0], [250.0, 320.0], [270.0, 260.0]],
    ]
    page.wait_for_function(f"({GREEN})('picture') > 200")
    server.path = []
    page.wait_for_function(f"({GREEN})('picture') === 0")


def test_guide_acts_and_typed_values(server, open_page):
    page = open_page()
    page.click("#menu-open")
    page.click("#guide-two-tap")
    assert server.wait_for("guide_start")["kind"] == "two_tap"
    server.push(GUIDE | {"theta_deg": 8.2, "hint": "turn 3° left"})
    page.wait_for_selector("#guide:not([hidden])")
    assert page.locator("#guide-theta").input_value() == "8.20"
    page.click("#guide-acts >> text=Turn")
    assert server.wait_for("guide_act")["act"] == "turn"
    page.fill("#guide-theta", "12.5")
    page.keyboard.press("Tab")
    page.fill("#guide-distance", "20")
    page.keyboard.press("Tab")
    server.wait_for("guide_value", 2)
    values = [(value["name"], value["value"]) for value in server.heard("guide_value")]
    assert values == [("theta_deg", 12.5), ("distance", pytest.approx(0.2))]
    page.fill("#guide-theta", "")
    page.keyboard.press("Tab")
    assert server.wait_for("guide_value", 3)["value"] is None
    page.click("#guide-close")
    server.wait_for("guide_end")
    server.push({"type": "guide", "kind": None})
    page.wait_for_selector("#guide", state="hidden")


def test_typing_a_number_drives_nothing_and_a_value_under_the_fingers_stays(server, open_page):
    page = open_page()
    server.push(GUIDE | {"theta_deg": 1.0})
    page.focus("#guide-theta")
    page.keyboard.press("ArrowUp")
    page.keyboard.press("Control+a")
    page.keyboard.type("15")
    server.push(GUIDE | {"theta_deg": 2.0, "hint": "on"})
    page.wait_for_selector("#guide-hint:text-is('On')")
    assert page.locator("#guide-theta").input_value() == "15"
    assert server.heard("drive") == []
    page.keyboard.press("Escape")
    server.wait_for("emergency_stop")


def test_captures_are_listed_downloaded_and_deleted_after_a_question(server, open_page):
    names = [f"20260131-12000{i}-f{i}" for i in (1, 2)]
    server.captures = [
        {"id": name, "taken_at": "2026-01-31T12:00:01", "width": 640, "height": 480, "frame_id": 1}
        for name in names
    ]
    page = open_page()
    page.wait_for_selector("#captures-count:text-is('2')")
    page.click("#captures-open")
    with page.expect_download() as download:
        page.click(".thumb a >> nth=0")
    assert download.value.suggested_filename == f"{names[0]}.jpg"
    page.click(".thumb >> nth=0 >> button")
    assert len(server.captures) == 2
    page.click(".thumb >> text=Keep")
    page.click(".thumb >> nth=0 >> button")
    page.click(".thumb .button--stop")
    page.wait_for_function("document.querySelectorAll('.thumb').length === 1")
    assert [capture["id"] for capture in server.captures] == names[1:]
    page.click("#captures-close")
    assert page.locator("#captures").is_hidden()


def test_three_hints_go_by_doing_or_by_pressing_and_never_come_back(server, open_page):
    page = open_page(hints="")
    assert page.locator("#hint-title").inner_text() == "Hold to drive"
    page.keyboard.press("w")
    page.wait_for_selector("#hint-title:text-is('Tap the red can')")
    page.mouse.click(512, 400)
    page.wait_for_selector("#hint-title:text-is('This is how sure it is')")
    page.click("#hint-next")
    assert page.locator("#hint").is_hidden()
    page.reload()
    page.wait_for_selector("body:not(.cannot-drive)")
    assert page.locator("#hint").is_hidden()
    page.click("#menu-open")
    page.click("#menu-hints")
    page.click("#hint-close")
    assert page.locator("#hint").is_hidden()


def test_number_keys_choose_the_step(server, open_page):
    page = open_page()
    page.keyboard.press("5")
    assert page.locator("#step-value").inner_text() == "50°"


def test_a_menu_gives_the_focus_back_to_what_opened_it(server, open_page):
    page = open_page()
    page.click("#step-open")
    page.click("#steps button >> nth=0")
    assert page.locator("#step-menu").is_hidden()
    assert page.evaluate("document.activeElement.id") == "step-open"


def test_a_menu_closes_by_a_tap_elsewhere(server, open_page):
    page = open_page()
    page.click("#menu-open")
    assert page.get_attribute("#menu-open", "aria-expanded") == "true"
    page.mouse.click(700, 300)
    assert page.locator("#menu").is_hidden()
    assert page.get_attribute("#menu-open", "aria-expanded") == "false"


def test_text_from_outside_is_never_markup(server, open_page):
    page = open_page()
    server.push(TARGET | {"advice": "<img src=x onerror=alert(1)>"})
    page.wait_for_selector("#card:not([hidden])")
    assert page.locator("#card img").count() == 0
    assert page.locator("#card-advice").inner_text().startswith("<img")
