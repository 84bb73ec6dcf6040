"""Does the board answer, which firmware is on it, how is its battery, and what do its servos say?"""

import re

from tapreach.cli.checkup.check import Check, Verdict, graded
from tapreach.drivers.arduino.fault_words import fault_sentence, restart_sentence
from tapreach.drivers.arduino.servos import ServoMap
from tapreach.drivers.arduino.visit import BoardVisit
from tapreach.drivers.arduino.wire import TELEMETRY_HZ, Fault, Feature, ResetCause, Telemetry, Welcome
from tapreach.resources import resource_path
from tapreach.robot.arm_section import ArmSection
from tapreach.robot.clock import MS, SECOND, Clock

LOOK_NS = 1 * SECOND
DOUBTFUL_MS, USELESS_MS = 20.0, 60.0
"""Commands count as too old after 150 ms, ahead of their time after 50: the alignment must be far better."""
FEW_HZ, FAR_TOO_FEW_HZ = 0.9 * TELEMETRY_HZ, 0.5 * TELEMETRY_HZ
NEARLY_EMPTY_MV = 6600
"""The firmware takes the wheels off below 6000 mV unless it was built with another BATTERY_LOW_MV."""
SERVO_NAMES = ("rotation", "shoulder", "elbow", "claw")
NOT_ASKED = "mend the link first"


async def check_board(visit: BoardVisit, arm: ArmSection, clock: Clock) -> list[Check]:
    """Look at the board of a visit that has been entered; moves nothing."""
    if not await visit.opened():
        unknown = "not known without the link"
        rest = ("firmware", "battery", "servos")
        return [
            Check("link", Verdict.FAIL, "the board does not answer", visit.reason),
            *(Check(name, Verdict.FAIL, unknown, NOT_ASKED) for name in rest),
        ]
    before, began_ns = visit.telemetry_count, clock.now_ns()
    await visit.talk.pause(LOOK_NS)
    rate_hz = (visit.telemetry_count - before) * SECOND / (clock.now_ns() - began_ns)
    if visit.telemetry is None or visit.welcome is None:
        return [Check("link", Verdict.FAIL, "the board fell silent while it was looked at", visit.reason)]
    told = visit.telemetry
    link = _link(rate_hz, (visit.session.board_clock.doubt_ns(clock.now_ns()) or 0) / MS, visit)
    return [link, _firmware(visit.welcome, told.faults), _battery(told, visit.welcome), _servos(told, arm)]


def _link(rate_hz: float, doubt_ms: float, visit: BoardVisit) -> Check:
    bad = visit.session.bad_frames
    verdicts = {
        "its clock is known too badly: a cable, or a quicker network": graded(
            doubt_ms, DOUBTFUL_MS, USELESS_MS
        ),
        "it tells too little: a higher [link] baud, or a quicker network": graded(
            rate_hz, FEW_HZ, FAR_TOO_FEW_HZ
        ),
        "what comes is damaged: a shorter cable away from the motors, a common ground": (
            Verdict.WARN if bad else Verdict.OK
        ),
    }
    found = (
        f"{visit.address} answers, {rate_hz:.0f} reports/s, clocks aligned to {doubt_ms:.1f} ms, "
        f"{bad} damaged frames"
    )
    figures: dict[str, float | str] = {"reports_hz": round(rate_hz, 1), "clock_doubt_ms": round(doubt_ms, 2)}
    advice = "; ".join(words for words, verdict in verdicts.items() if verdict is not Verdict.OK)
    verdict = max(verdicts.values(), key=list(Verdict).index)
    return Check("link", verdict, found, advice, figures | {"damaged_frames": bad})


def _firmware(welcome: Welcome, faults: Fault) -> Check:
    can = ", ".join(_words(feature) for feature in Feature if feature in welcome.features)
    found = f"version {welcome.firmware} for {welcome.board.name.lower()}: {can or 'no features'}"
    figures: dict[str, float | str] = {
        "firmware": welcome.firmware,
        "protocol": welcome.version,
        "board": welcome.board.name.lower(),
        "features": can,
    }
    if faults:
        return Check("firmware", Verdict.FAIL, f"{found}; a fault stands", fault_sentence(faults), figures)
    if welcome.firmware != (shipped := shipped_firmware()):
        older = "older" if welcome.firmware < shipped else "newer"
        advice = (
            f"{older} than the firmware that comes with this Tapreach, {shipped}: tapreach firmware flash"
        )
        return Check("firmware", Verdict.WARN, found, advice, figures)
    if welcome.reset_cause & (ResetCause.BROWN_OUT | ResetCause.WATCHDOG) and not (
        welcome.reset_cause & ResetCause.POWER_ON
    ):
        return Check("firmware", Verdict.WARN, found, restart_sentence(welcome.reset_cause), figures)
    return Check("firmware", Verdict.OK, found, "", figures)


def shipped_firmware() -> int:
    """Return the version of the firmware that comes with this Tapreach."""
    text = (resource_path("firmware") / "tapreach" / "hardware.h").read_text(encoding="utf-8")
    found = re.search(r"FIRMWARE_VERSION = (\d+);", text)
    assert found is not None, "firmware/tapreach/hardware.h says no version"
    return int(found.group(1))


def _words(feature: Feature) -> str:
    return (feature.name or "").lower().replace("_", " ")


def _battery(told: Telemetry, welcome: Welcome) -> Check:
    figures: dict[str, float | str] = {"battery_mv": told.battery_mv}
    if not told.battery_mv:
        wire = "wire it through the divider of docs/hardware.md: motors that starve reset the board"
        is_measured = Feature.BATTERY in welcome.features
        advice = wire if is_measured else "this firmware measures none"
        return Check("battery", Verdict.WARN, "not measured, or switched off", advice, figures)
    found = f"{told.battery_mv / 1000:.2f} V"
    if Fault.BATTERY_LOW in told.faults:
        return Check("battery", Verdict.FAIL, f"{found}: too low to drive", "charge it", figures)
    if told.battery_mv < NEARLY_EMPTY_MV:
        return Check("battery", Verdict.WARN, f"{found}: nearly empty", "charge it soon", figures)
    return Check("battery", Verdict.OK, found, "", figures)


def _servos(told: Telemetry, arm: ArmSection) -> Check:
    limits = [(servo.low_us, servo.high_us) for servo in ServoMap(arm).servos]
    pairs = list(zip(SERVO_NAMES, told.pulse_us, limits, strict=True))
    outside = [f"{name} {pulse}" for name, pulse, (low, high) in pairs if pulse and not low <= pulse <= high]
    shown = ", ".join(f"{name} {pulse} µs" if pulse else f"{name} off" for name, pulse, _ in pairs)
    figures: dict[str, float | str] = {f"{name}_us": pulse for name, pulse, _ in pairs}
    if outside:
        advice = f"outside [arm.servos]: {', '.join(outside)} µs; run tapreach doctor --teach servos"
        return Check("servos", Verdict.WARN, shown, advice, figures)
    return Check("servos", Verdict.OK, shown, "", figures)
