"""Connections: heartbeat, loss and return, refusal, and who drives."""

import itertools

import pytest
from tests.web.conftest import wait_ready


def test_heartbeats_at_20_hz_only_while_holding_the_lease(server, open_page):
    page = open_page()
    server.wait_for("heartbeat", 10)
    beats = server.heard("heartbeat")
    gaps = sorted(b["client_ms"] - a["client_ms"] for a, b in itertools.pairwise(beats))
    assert 30 <= gaps[len(gaps) // 2] <= 90
    page.click("#lease-action")
    server.wait_for("lease_release")
    page.wait_for_selector("#lease-action:text-is('Drive')")
    server.forget()
    server.wait_for("ping")
    assert server.heard("heartbeat") == []


def test_a_frozen_tab_sends_no_heartbeat_although_its_worker_lives(server, open_page):
    page = open_page()
    server.wait_for("heartbeat", 3)
    page.evaluate(
        "() => { const end = performance.now() + 2500; while (performance.now() < end); return 0; }"
    )
    pings = server.heard("ping")
    server.wait_for("heartbeat", len(server.heard("heartbeat")) + 2)
    stamps = [message["client_ms"] for message in server.heard("heartbeat")]
    gap, begin = max((b - a, a) for a, b in itertools.pairwise(stamps))
    assert gap > 2300
    assert any(begin + 300 < ping["client_ms"] < begin + gap for ping in pings)


def test_a_hidden_tab_sends_no_heartbeat(server, open_page):
    page = open_page()
    server.wait_for("heartbeat", 3)
    page.evaluate("Object.defineProperty(document, 'hidden', {value: true})")
    server.wait_for("ping", len(server.heard("ping")) + 1)
    server.forget()
    server.wait_for("ping")
    assert server.heard("heartbeat") == []


def test_the_page_says_that_the_server_is_gone_and_comes_back(server, open_page):
    page = open_page()
    server.refuses = True
    server.drop_sockets()
    page.wait_for_selector("#veil:not([hidden])")
    assert page.locator("#veil-title").inner_text() in ("Connection lost", "Not paired")
    page.keyboard.press("w")
    assert page.locator("#toast").inner_text() == "No connection to the robot."
    server.refuses = False
    wait_ready(page)
    assert page.locator("#veil").is_hidden()


def test_a_silent_socket_is_given_up_and_opened_anew(server, open_page):
    page = open_page()
    server.silent_session = 1
    server.wait_for("hello", 2)
    wait_ready(page)


def test_a_page_that_is_not_paired_is_told_so(server, open_page):
    server.refuses = True
    page = open_page(is_ready=False)
    page.wait_for_selector("#veil-title:text-is('Not paired')")
    assert "printed address" in page.locator("#veil-text").inner_text()
    assert page.locator("#stop").is_visible()


def test_a_lost_robot_is_named_with_its_reason(server, open_page):
    page = open_page()
    server.change(health="lost", health_reason="The camera process ended: exit code 9.")
    page.wait_for_selector("#veil[data-kind=lost]")
    assert page.locator("#veil-text").inner_text() == "The camera process ended: exit code 9."
    assert page.locator("#link-text").inner_text() == "Robot lost"


def test_the_second_page_watches_asks_and_is_granted(server, open_page):
    first = open_page()
    second = open_page(is_ready=False)
    second.wait_for_selector("#lease-action:text-is('Ask to drive')")
    second.keyboard.press("w")
    assert "drives. Ask to take over first." in second.locator("#toast").inner_text()
    second.click("#lease-action")
    first.wait_for_selector("#asked:not([hidden])")
    first.click("#asked-grant")
    answer = server.wait_for("lease_answer")
    assert (answer["session_id"], answer["grant"]) == (2, True)
    lease = server.state["lease"]
    server.change(lease=lease | {"holder_id": 2, "asked_by_id": None, "asked_by_name": ""})
    wait_ready(second)
    first.wait_for_selector("#lease-action:text-is('Ask to drive')")
    assert server.heard("drive") == []


def test_giving_back_stops_first_and_is_not_taken_again(server, open_page):
    page = open_page()
    page.click("#lease-action")
    server.wait_for("lease_release")
    page.wait_for_selector("#lease-who:text-is('Nobody')")
    kinds = [m["type"] for m in server.received if m["type"] in ("stop", "lease_release", "lease_request")]
    assert kinds == ["lease_request", "stop", "lease_release"]
    page.click("#lease-action")
    wait_ready(page)


@pytest.mark.parametrize("speed", [(0.12, 0.21, "acceleration"), (0.0, 0.0, "")])
def test_the_bar_shows_what_was_sent_and_what_limits_it(server, open_page, speed):
    linear, angular, limit = speed
    page = open_page()
    server.change(sent={"linear": linear, "angular": angular}, limited_by=limit)
    words = "Forward 0.12 m/s, left 12°/s" if linear else "Still"
    page.wait_for_selector(f"#motion:text-is('{words}')")
    assert page.locator("#motion-label").inner_text() == (f"Limited: {limit}" if limit else "Robot")
    assert page.locator("#odometry").inner_text() == "x 0.31  y \u22120.02 m  12°"


def test_age_and_round_trip_are_shown(server, open_page):
    page = open_page()
    for label in ("#age", "#rtt"):
        page.wait_for_function("id => / ms$/.test(document.querySelector(id).textContent)", arg=label)


def test_the_age_of_the_picture_counts_from_its_capture(server, open_page):
    """A picture that comes fast but was captured long ago is frozen."""
    server.frozen_after_ms = 500
    page = open_page()
    server.capture_delay_ns = 900_000_000
    page.wait_for_selector("#veil[data-kind=frozen]")
    age = page.locator("#veil-title").inner_text()
    assert 0.9 <= float(age.split()[1]) < 2.0


def test_nothing_is_asked_from_anywhere_else(server, open_page, browser):
    page = browser.new_page()
    asked = []
    page.on("request", lambda request: asked.append(request.url))
    page.on("websocket", lambda socket: asked.append(socket.url.replace("ws:", "http:")))
    page.goto(server.url)
    server.wait_for("heartbeat", 3)
    page.close()
    assert [url for url in asked if not url.startswith((server.url, "data:"))] == []
    assert any(url.endswith("/ws/video") for url in asked)
