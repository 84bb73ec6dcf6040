"""A whole fetch from the page on a real robot's machine code, in real time: tap, agree, and it is lifted."""

import re
from pathlib import Path

import pytest
from playwright.sync_api import Browser, expect
from tests.firmware.sim.live_process import live_process
from tests.firmware.sim.needs import needs_bed
from tests.scenarios.conftest import operating
from tests.scenarios.running import tapreach_run
from tests.scenarios.test_over_the_firmware import in_real_time, settle

pytestmark = [needs_bed, pytest.mark.timeout(400)]
LIFTED = 0.05


def test_tapped_can_is_asked_about_fetched_and_held(browser: Browser, tmp_path: Path) -> None:
    with (
        live_process("near", tmp_path) as robot,
        tapreach_run(tmp_path, "--robot", str(robot.robot_file)) as run,
        operating(browser, run.address, "near") as operator,
    ):
        settle(robot)
        stood = robot.look().heights["red can"]
        with in_real_time(robot):
            operator.page.click("#purpose-fetch")
            operator.tap("red can")
            operator.page.locator("#fetch-acts >> text=Fetch it").click()
            held = re.compile("^Holds")
            expect(operator.page.locator("#fetch-does")).to_have_text(held, timeout=150_000)
            assert robot.look().heights["red can"] > stood + LIFTED
