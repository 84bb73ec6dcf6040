"""What the board tells in bits, in words a person can act on."""

from tapreach.drivers.arduino.wire import Fault, ResetCause, Result

FAULTS = {
    Fault.STOP_INPUT: "the stop button is pressed: release it, then clear the fault",
    Fault.ENCODER_STUCK: "a motor has power and its encoder counts nothing: free the wheel, check its cable",
    Fault.ENCODER_ILLEGAL: "an encoder counts what cannot be: check its cable and its supply",
    Fault.BATTERY_LOW: "the battery is too low to drive: charge it",
    Fault.LOOP_OVERRUN: "the board was late with its wheel control: report this with the firmware's version",
    Fault.WATCHDOG_RESET: "the board hung and restarted itself: report this with the firmware's version",
    Fault.BROWN_OUT_RESET: "the board's supply broke down: charge the battery, give motors their own supply",
}
RESETS = {
    ResetCause.BROWN_OUT: "its supply broke down: charge the battery, give motors their own supply",
    ResetCause.WATCHDOG: "its program hung: report this with the firmware's version",
    ResetCause(2): "its reset pin was pulled",
    ResetCause.POWER_ON: "it was without power",
}
REFUSALS = {
    Result.UNKNOWN: "the firmware does not know this command: flash the firmware of this version",
    Result.BAD_LENGTH: "the firmware expects another length: flash the firmware of this version",
    Result.OUT_OF_RANGE: "a value is outside the firmware's limits: correct the robot file",
    Result.TOO_OLD: "the command came too late",
    Result.NEEDS_ZERO: "wheels need a zero first",
    Result.FAULTED: "a fault stands",
    Result.BUSY: "the wheels still turn",
    Result.NO_SESSION: "the board knows no session",
}


def fault_sentence(faults: Fault) -> str:
    """Return what stands latched; '' for nothing."""
    return "; ".join(words for fault, words in FAULTS.items() if fault in faults)


def restart_sentence(cause: ResetCause) -> str:
    """Return that the board has restarted and why, as far as it knows."""
    why = next((words for each, words in RESETS.items() if each in cause), "it does not know why")
    return f"the board restarted: {why}"


def refusal_words(result: Result) -> str:
    """Return what a refused command means."""
    return REFUSALS.get(result, "")
