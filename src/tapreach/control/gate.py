"""The gate: nothing moves unless everything here allows it. Pure decisions; whoever calls holds the clock."""

from dataclasses import dataclass

from tapreach.control.deadman import Wish
from tapreach.control.speed_limit import SpeedLimits, limited, ramped
from tapreach.robot.clock import MS
from tapreach.robot.messages import STILL, Health, Twist

STALE_NS = 200 * MS
"""A command this old on arrival is dropped."""
FROZEN_NS = 500 * MS
"""A picture this old is no basis for driving."""


@dataclass(frozen=True, slots=True)
class Circumstances:
    """What the gate looks at, all of one moment. The defaults deny."""

    now_ns: int
    health: Health
    emergency_stop: str
    has_lease: bool = False
    """Whoever wishes, or owns the running task, holds the lease."""
    operator_is_alive: bool = False
    """Heard within the deadman's timeout."""


@dataclass(frozen=True, slots=True)
class Decision:
    """What may be sent, and why it is less than wished ('' when it is not)."""

    twist: Twist
    reason: str = ""


def refusal(circumstances: Circumstances) -> str:
    """Return why nothing may move, or ''. Holds for operator and task alike."""
    if circumstances.emergency_stop:
        return f"emergency stop {circumstances.emergency_stop}"
    if not circumstances.health.is_running:
        return f"robot {circumstances.health.status}: {circumstances.health.reason}".removesuffix(": ")
    if not circumstances.has_lease:
        return "you do not have the lease: ask to drive first"
    if not circumstances.operator_is_alive:
        return "operator not heard for 200 ms"
    return ""


def command_refusal(age_ns: int) -> str:
    """Return why a command of this age on arrival is dropped, or ''."""
    return f"command {age_ns // MS} ms old on arrival (at most {STALE_NS // MS})" if age_ns > STALE_NS else ""


def picture_refusal(captured_ns: int | None, now_ns: int) -> str:
    """Return why a picture is no basis for driving, or ''."""
    if captured_ns is None:
        return "no picture on the screen"
    age_ns = now_ns - captured_ns
    return f"picture {age_ns // MS} ms old (at most {FROZEN_NS // MS})" if age_ns > FROZEN_NS else ""


class Gate:
    """Limits and ramps; remembers what it let through last, since ramps start there."""

    def __init__(self, limits: SpeedLimits) -> None:
        self._limits = limits
        self._last = STILL

    def operator(self, wish: Wish | None, circumstances: Circumstances, duration: float) -> Decision:
        """Decide on what the operator holds, `duration` [s] after the last decision."""
        if wish is None or wish.twist.is_zero:
            return self.stop()
        reason = refusal(circumstances) or picture_refusal(wish.picture_captured_ns, circumstances.now_ns)
        return self.stop(reason) if reason else self._move(wish.twist, duration)

    def task(self, twist: Twist, circumstances: Circumstances, duration: float) -> Decision:
        """Decide on what a running task asks for; the age of the operator's picture does not matter."""
        reason = refusal(circumstances)
        return self.stop(reason) if reason else self._move(twist, duration)

    def stop(self, reason: str = "") -> Decision:
        """Zero, now."""
        self._last = STILL
        return Decision(STILL, reason)

    def _move(self, wanted: Twist, duration: float) -> Decision:
        slower = limited(wanted, self._limits)
        twist = ramped(self._last, slower, duration, self._limits)
        self._last = twist
        return Decision(
            twist, "speed limit" if slower != wanted else "speeding up" if twist != slower else ""
        )
