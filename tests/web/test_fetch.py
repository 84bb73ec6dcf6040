"""Fetching on the page: how it is asked for, what is told of it, and what can be said to it."""

import pytest
from tests.web.test_panels import GREEN, TARGET

FETCH = {
    "type": "fetch",
    "phase": "confirm",
    "target_id": 1,
    "does": "waits for the operator's word",
    "why": "the claw comes from the front",
    "next": "looks at its own claw",
    "progress": 0.3,
    "attempt": 1,
    "verdict": "yes",
    "reason": "6.6 cm wide, the claw opens to 7.3 cm",
    "advice": "",
    "seconds": 24.0,
    "path": [[0.31, -0.02, 0.2], [0.95, 0.25, 0.35]],
    "grasp": [[[1.1, 0.32], [1.2, 0.36]]],
    "may_confirm": True,
    "may_resume": False,
    "stopped": "",
    "condition": "",
    "verbs": [],
}
NOT_WAITING = {"may_confirm": False, "phase": "approach"}


def test_a_tap_with_fetch_asks_for_it_in_the_chosen_mode(server, open_page):
    page = open_page()
    page.click("#purpose-fetch")
    page.mouse.click(512, 300)
    fetch = server.wait_for("fetch")
    assert fetch["mode"] == "confirm" and fetch["frame_id"] >= 1 and fetch["u"] > 0
    page.click("#menu-open")
    page.click("#mode-go")
    page.reload()
    page.wait_for_selector("body:not(.cannot-drive)")
    assert page.locator("#mode-go").get_attribute("aria-checked") == "true"


def test_a_located_target_can_be_fetched_from_its_card(server, open_page):
    page = open_page()
    server.push(TARGET)
    page.click("#card-fetch")
    assert server.wait_for("fetch")["target_id"] == 1
    server.push(TARGET | {"source": "floor"})
    page.wait_for_selector("#card-fetch", state="hidden")


def test_the_plan_is_told_and_drawn_and_waits_for_a_word(server, open_page):
    page = open_page()
    server.push(TARGET)
    server.push(FETCH)
    page.wait_for_selector("#fetch:not([hidden])")
    assert page.locator("#fetch-verdict").inner_text() == "Can be fetched, about 24 s"
    assert page.locator("#fetch-reason").inner_text() == "6.6 cm wide, the claw opens to 7.3 cm"
    assert page.locator("#fetch-next").inner_text() == "Next: looks at its own claw"
    page.wait_for_function(f"({GREEN})('plan') > 20")
    page.click("#fetch-acts >> text=Fetch it")
    server.wait_for("fetch_confirm")
    server.push(FETCH | NOT_WAITING)
    page.wait_for_selector("#fetch-acts:empty", state="attached")


def test_a_refusal_says_why_and_what_would_help(server, open_page):
    page = open_page()
    why = {"verdict": "no", "reason": "28 mm too wide for the claw", "advice": "turn it", "phase": "refused"}
    server.push(FETCH | NOT_WAITING | why | {"seconds": None})
    page.wait_for_selector("#fetch-verdict:text-is('Cannot be fetched')")
    assert page.locator("#fetch-reason").inner_text() == "28 mm too wide for the claw. Turn it"


def test_after_a_stop_the_page_says_how_the_robot_stands_and_offers_to_go_on(server, open_page):
    page = open_page()
    stop = {"stopped": "stopped by Anna", "condition": "the robot stands", "may_resume": True}
    server.push(FETCH | NOT_WAITING | stop)
    page.wait_for_selector("#fetch-does:text-is('Stopped: stopped by Anna')")
    assert page.locator("#fetch-why").inner_text() == "The robot stands"
    page.click("#fetch-acts >> text=Go on")
    server.wait_for("fetch_resume")


@pytest.mark.parametrize(
    ("name", "verb"), [("Bring back", "bring_back"), ("Put down", "put_down"), ("Hand over", "hand_over")]
)
def test_what_can_be_done_with_a_held_thing(server, open_page, name, verb):
    page = open_page()
    server.push(FETCH | NOT_WAITING | {"phase": "held", "verbs": ["bring_back", "put_down", "hand_over"]})
    page.wait_for_selector("#fetch-verdict:text-is('Held')")
    page.click(f"#fetch-acts >> text={name}")
    assert server.wait_for("fetch_verb")["verb"] == verb


@pytest.mark.parametrize("size", [(1024, 768), (390, 844), (844, 390), (1440, 900)])
def test_the_word_can_be_given_at_any_size(server, open_page, size):
    page = open_page(size)
    server.push(TARGET)
    server.push(FETCH)
    box = page.locator("#fetch-acts >> text=Fetch it").bounding_box()
    stop = page.locator("#stop").bounding_box()
    assert box["height"] >= 44 and box["y"] + box["height"] <= size[1]
    is_beside = box["x"] + box["width"] <= stop["x"] or box["y"] + box["height"] <= stop["y"]
    assert is_beside
