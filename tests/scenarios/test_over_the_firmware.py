"""The whole product on a real robot's machine code: page, server, driver, device path, firmware, physics.

Everything is in real time here, and so is every deadman; see test_tap_to_position.
"""

import signal
import time
from collections.abc import Iterator
from contextlib import contextmanager

import pytest
from playwright.sync_api import Browser
from playwright.sync_api import Error as PlaywrightError
from tests.firmware.sim.live_process import LiveProcess, Look, live_process
from tests.firmware.sim.needs import needs_bed
from tests.scenarios.conftest import Operator, operating
from tests.scenarios.running import Running, tapreach_run
from tests.scenarios.test_tap_to_position import locate

from tapreach.drivers.arduino import wire

pytestmark = needs_bed
PERIOD_MS = 1000 / wire.CONTROL_HZ
ON_THE_WAY_MS = 10.0
"""What a command may still be under way, in the line and between two steps of the bridge."""
MOST_LAG_S = 0.02
"""A board or a picture that falls behind by more is none: so sure are times by the robot file."""
Live = tuple[Operator, Running, LiveProcess]


@contextmanager
def in_real_time(robot: LiveProcess) -> Iterator[None]:
    """Judge what happens only where the machine keeps up with the simulation."""
    robot.look()
    robot.worst_lag_s = 0.0
    try:
        yield
    except (AssertionError, PlaywrightError):
        robot.look()
        if robot.worst_lag_s > MOST_LAG_S:
            pytest.skip(f"the simulated board fell {robot.worst_lag_s:.2f} s behind: no real time here")
        raise


@pytest.fixture(scope="module")
def live(browser: Browser, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Live]:
    folder = tmp_path_factory.mktemp("live")
    with (
        live_process("room", folder) as robot,
        tapreach_run(folder, "--robot", str(robot.robot_file)) as run,
        operating(browser, run.address, "room") as person,
    ):
        settle(robot)
        yield person, run, robot


def settle(robot: LiveProcess) -> None:
    """Wait until the board's time goes with ours: starting all this keeps a small machine busy."""
    end_s = time.monotonic() + 20.0
    while time.monotonic() < end_s:
        robot.look()
        time.sleep(1.0)
        if robot.look().worst_lag_s < MOST_LAG_S:
            return


def test_one_tap_on_the_page_locates_the_red_can(live: Live) -> None:
    operator, _, robot = live
    with in_real_time(robot):
        locate(operator, "red can")
        assert operator.error("red can") < operator.radius_of("red can") + 0.03
        assert robot.look().powered_us > 100_000


def test_wheels_lose_their_power_when_the_program_is_halted(live: Live) -> None:
    operator, run, robot = live
    with in_real_time(robot):
        halted = halted_while_driving(operator, run, robot)
        time.sleep(0.5)
        later = robot.look()
        run.process.send_signal(signal.SIGCONT)
        assert later.off_since_us < later.now_us
        held_ms = (later.off_since_us - halted.now_us) / 1000
        assert held_ms <= wire.DEADMAN_MS + PERIOD_MS + ON_THE_WAY_MS


def halted_while_driving(operator: Operator, run: Running, robot: LiveProcess) -> Look:
    """Hold the page's button, halt the program while the wheels have power; return the moment."""
    operator.page.locator("[data-drive=forward]").hover()
    operator.page.mouse.down()
    end_s = time.monotonic() + 20.0
    while time.monotonic() < end_s:
        operator.page.wait_for_timeout(300)
        if any(robot.look().duties):
            run.process.send_signal(signal.SIGSTOP)
            return robot.look()
    raise AssertionError("the wheels never turned")
