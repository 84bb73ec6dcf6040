"""What the doctor says of a board, well or ill."""

from dataclasses import replace

import pytest
from tests.cli.visited_board import play_visit
from tests.drivers.arduino.peer import PeerBoard

from tapreach.cli.checkup.board_check import check_board
from tapreach.cli.checkup.check import Verdict
from tapreach.drivers.arduino.wire import Drive, Fault, Hello, Move, Ping, ResetCause, Servos, Stop, Welcome
from tapreach.resources import resource_path
from tapreach.robot.config import load_robot

ARM = load_robot(resource_path("robots") / "rover-pi.toml").arm


class IllBoard(PeerBoard):
    """Tells what a test wants."""

    battery_mv, pulses_told = 7400, (0, 0, 0, 0)

    def telemetry(self):
        return replace(super().telemetry(), battery_mv=self.battery_mv, pulse_us=self.pulses_told)


def checked(change=lambda board: None, **options):
    async def scenario(visit, board, clock):
        change(board)
        checks = {check.name: check for check in await check_board(visit, ARM, clock)}
        return checks, board

    return play_visit(scenario, IllBoard, **options)


def test_board_that_is_well_passes_with_its_figures_and_is_left_as_it_is():
    checks, board = checked()
    assert {name: check.verdict for name, check in checks.items()} == dict.fromkeys(
        ("link", "firmware", "battery", "servos"), Verdict.OK
    )
    assert checks["link"].figures["reports_hz"] == pytest.approx(50, abs=3)
    assert checks["link"].figures["clock_doubt_ms"] < 5
    assert "version 1 for uno: quadrature, servos" in checks["firmware"].found
    assert checks["battery"].found == "7.40 V"
    assert not any(isinstance(message, Drive | Move | Servos) for message in board.asked)
    assert {type(message) for message in board.asked} == {Hello, Ping, Stop}


@pytest.mark.parametrize(("version", "word"), [(0, "older"), (9, "newer")])
def test_firmware_of_another_version_is_a_warning_with_the_way_to_flash(version, word):
    class Other(IllBoard):
        def say(self, message):
            is_welcome = isinstance(message, Welcome)
            super().say(replace(message, firmware=version) if is_welcome else message)

    async def scenario(visit, board, clock):
        return {check.name: check for check in await check_board(visit, ARM, clock)}

    firmware = play_visit(scenario, Other)["firmware"]
    assert firmware.verdict is Verdict.WARN
    assert word in firmware.advice and "tapreach firmware flash" in firmware.advice


def test_mute_board_fails_with_the_firmware_to_flash_and_the_rest_is_unknown():
    checks, _ = checked(lambda board: setattr(board, "is_mute", True))
    assert checks["link"].verdict is Verdict.FAIL
    assert "tapreach firmware flash" in checks["link"].advice
    assert {checks[name].verdict for name in ("firmware", "battery", "servos")} == {Verdict.FAIL}


def test_port_that_is_not_there_is_said_with_what_to_do():
    def missing(section, hear, end):
        raise FileNotFoundError(2, "no such device")

    checks, _ = checked(open_port=missing)
    assert "/dev/peer is not there: plug the board in" in checks["link"].advice


def test_other_protocol_version_is_said_with_what_to_do():
    checks, _ = checked(lambda board: setattr(board, "version", 9))
    assert "protocol version 9" in checks["link"].advice


def test_latched_fault_fails_the_firmware_in_words():
    checks, _ = checked(lambda board: board.latch(Fault.ENCODER_STUCK))
    assert checks["firmware"].verdict is Verdict.FAIL
    assert "free the wheel, check its cable" in checks["firmware"].advice


def test_brown_out_before_is_a_warning_about_the_supply():
    checks, _ = checked(lambda board: board.reboot(ResetCause.BROWN_OUT))
    assert checks["firmware"].verdict is Verdict.WARN
    assert "give motors their own supply" in checks["firmware"].advice


@pytest.mark.parametrize(
    ("battery_mv", "faults", "verdict", "word"),
    [
        (0, Fault(0), Verdict.WARN, "measures none"),
        (6300, Fault(0), Verdict.WARN, "charge it soon"),
        (5800, Fault.BATTERY_LOW, Verdict.FAIL, "charge it"),
    ],
)
def test_battery_that_is_low_or_unknown_is_said(battery_mv, faults, verdict, word):
    def change(board):
        board.battery_mv = battery_mv
        board.latch(faults)

    checks, _ = checked(change)
    assert (checks["battery"].verdict, word in checks["battery"].advice) == (verdict, True)


def test_servo_outside_the_robot_file_is_named():
    checks, _ = checked(lambda board: setattr(board, "pulses_told", (1500, 2300, 0, 0)))
    assert checks["servos"].verdict is Verdict.WARN
    assert "shoulder 2300" in checks["servos"].advice
    assert "rotation 1500 µs, shoulder 2300 µs, elbow off" in checks["servos"].found


def test_damaged_bytes_warn_of_the_cable():
    async def scenario(visit, board, clock):
        await visit.opened()
        for _ in range(5):
            board.write(b"\x00\x07noise\x00")
        return await check_board(visit, ARM, clock)

    link = play_visit(scenario)[0]
    assert link.verdict is Verdict.WARN
    assert "shorter cable" in link.advice
