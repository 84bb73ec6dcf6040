"""The main job, end to end: page, server, tasks, simulated rover; checked against where the things stand.

The page's deadman is real here: on a starved machine the robot may stop because its operator was not heard
for 200 ms, as it should. Then the operator does what a person would do: taps again.
"""

import re

import numpy as np
from playwright.sync_api import expect
from tests.scenarios.conftest import Operator

TRIES = 4


def test_one_tap_locates_the_red_can(operator: Operator) -> None:
    locate(operator, "red can")
    _, half_width = operator.read_position()
    assert operator.error("red can") < operator.radius_of("red can") + 0.03
    assert np.all(half_width < 0.15)


def test_box_tells_how_large_the_red_can_is(operator: Operator) -> None:
    for _ in range(TRIES):
        operator.draw_around("red can")
        expect(operator.page.locator("#card-title")).to_have_text("Target")
        operator.wait_for_task()
        if operator.page.locator("#card-xyz dd").count():
            break
    told = operator.page.locator("#card-size").inner_text()
    width, _, height, _ = (float(word) for word in re.findall(r"[\d.]+", told))
    assert abs(width - 200 * operator.radius_of("red can")) < 1.5, told
    assert abs(height - 100 * operator.tall("red can")) < 2.5, told


def test_two_taps_guided_locate_the_red_can(operator: Operator) -> None:
    operator.page.locator("#menu-open").click()
    operator.page.locator("#guide-two-tap").click()
    act(operator, "Take pose")
    go_on(operator, "Centre the target")
    operator.tap("red can")
    expect(operator.page.locator("#guide-hint")).to_contain_text("left")
    act(operator, "Centre it", until="centre line")
    go_on(operator, "First tap")
    operator.tap("red can")
    expect(operator.page.locator("#guide-title")).to_have_text("Turn left")
    act(operator, "Turn", until="Turned 1")
    go_on(operator, "Advance")
    act(operator, "Advance", until="of 20 cm")
    go_on(operator, "Second tap")
    operator.tap("red can")
    expect(operator.page.locator("#guide-result")).to_contain_text("O_NEW")
    assert operator.error("red can") < operator.radius_of("red can") + 0.05


def test_floor_guess_is_there_at_once_and_drawn_as_a_guess(operator: Operator) -> None:
    operator.page.locator("#purpose-floor").click()
    operator.tap_pixel(320, 400)
    expect(operator.page.locator("#card-title")).to_have_text("Floor guess")
    position, _ = operator.read_position()
    assert abs(position[2]) < 0.01
    assert operator.page.locator("#card").get_attribute("data-source") == "floor"


def test_hold_drives_and_release_stops(operator: Operator) -> None:
    before = operator.odometry()
    forward = operator.page.locator("[data-drive=forward]")
    for _ in range(TRIES):
        forward.hover()
        operator.page.mouse.down()
        operator.page.wait_for_timeout(500)
        operator.page.mouse.up()
        if operator.odometry() != before:
            break
    assert operator.odometry() != before
    expect(operator.page.locator("#motion")).to_have_text("Still")
    assert operator.pose().x > 0.01


def test_cancel_during_locate_stops_at_once(operator: Operator) -> None:
    operator.tap("red can")
    operator.page.locator("#task-cancel").click()
    operator.wait_for_task()
    at_rest = operator.pose()
    operator.page.wait_for_timeout(500)
    assert operator.pose() == at_rest


def locate(operator: Operator, name: str) -> None:
    """Tap until there is a position."""
    for _ in range(TRIES):
        operator.tap(name)
        expect(operator.page.locator("#card-title")).to_have_text("Target")
        operator.wait_for_task()
        if operator.page.locator("#card-xyz dd").count():
            return
    raise AssertionError(operator.page.locator("#card").inner_text())


def act(operator: Operator, name: str, until: str = "") -> None:
    """Let the robot do a step of the guide until the hint says that it is done."""
    hint = operator.page.locator("#guide-hint")
    for _ in range(TRIES):
        operator.page.get_by_role("button", name=name, exact=True).click()
        operator.wait_for_task()
        if until in hint.inner_text():
            return
    raise AssertionError(operator.page.locator("#guide").inner_text())


def go_on(operator: Operator, title: str) -> None:
    """Press Next and see the step of this title."""
    operator.page.get_by_role("button", name="Next", exact=True).click()
    expect(operator.page.locator("#guide-title")).to_have_text(title)
