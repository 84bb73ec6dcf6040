"""The main job, end to end: page, server, tasks, simulated rover; checked against where the things stand."""

import numpy as np
from playwright.sync_api import expect
from tests.scenarios.conftest import MINUS, Operator


def test_one_tap_locates_the_red_can(operator: Operator) -> None:
    operator.tap("red can")
    expect(operator.page.locator("#task")).to_be_visible()
    expect(operator.page.locator("#task")).to_be_hidden(timeout=90_000)
    expect(operator.page.locator("#card-title")).to_have_text("Target")
    position, half_width = operator.read_position()
    assert _error(operator, "red can", position) < 0.05 + operator.radius_of("red can")
    assert np.all(half_width < 0.15)


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
    forward.hover()
    operator.page.mouse.down()
    expect(operator.page.locator("#odometry")).not_to_have_text(before)
    operator.page.mouse.up()
    expect(operator.page.locator("#motion")).to_have_text("Still")


def test_cancel_during_locate_stops_and_says_so(operator: Operator) -> None:
    operator.tap("red can")
    operator.page.locator("#task-cancel").click()
    expect(operator.page.locator("#task")).to_be_hidden(timeout=30_000)
    expect(operator.page.locator("#motion")).to_have_text("Still")


def _error(operator: Operator, name: str, position_in_base: np.ndarray) -> float:
    """Distance from the middle of the thing, with the robot where odometry says it is now."""
    x, y, heading = _numbers(operator.odometry())
    turn = np.array([[np.cos(heading), -np.sin(heading)], [np.sin(heading), np.cos(heading)]])
    in_world = np.array([*(turn @ position_in_base[:2] + [x, y]), position_in_base[2]])
    return float(np.linalg.norm(in_world - operator.middle_of(name)))


def _numbers(odometry: str) -> tuple[float, float, float]:
    """x [m], y [m], heading [rad] of 'x 0.10  y -0.02 m  3°'."""
    words = odometry.replace(MINUS, "-").replace("°", "").replace("m", "").split()
    return float(words[1]), float(words[3]), float(np.radians(float(words[4])))
