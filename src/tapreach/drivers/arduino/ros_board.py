"""A board with the firmware ros_arduino_bridge: fewer safeties there, so more of them here."""

from collections.abc import Callable

from tapreach.drivers.arduino.ros_arm import RosArm
from tapreach.drivers.arduino.ros_base import RosBase
from tapreach.drivers.arduino.ros_lines import RosLines
from tapreach.errors import ConfigError, LinkLost
from tapreach.robot.clock import SECOND, Clock
from tapreach.robot.config import RobotDescription
from tapreach.robot.messages import Health, LinkStatus

LOST_AFTER_TIMEOUTS = 3
NO_ANSWER_NS = 6 * SECOND
SILENT = (
    "the board does not answer ros_arduino_bridge's commands: check [link] baud (57600 is usual) and its "
    "firmware"
)


class RosBoard:
    """Asks for encoder counts all the time, sends wheel speeds between, and servo angles when they change."""

    def __init__(
        self,
        description: RobotDescription,
        clock: Clock,
        write: Callable[[bytes], None],
        tell: Callable[[Health], None],
    ) -> None:
        if description.link is None:
            raise ConfigError("the robot file has no [link]: without it no board is known")
        self._clock, self._tell = clock, tell
        self._lines = RosLines(clock, write)
        rate_hz = description.link.pid_rate_hz
        self.base = RosBase(description.base, rate_hz, clock, self._lines, self._require_link)
        self.arm = RosArm(description.arm, clock, self._lines, self._require_link)
        self._is_found = self.is_serving = False
        self._found_ns = 0
        self._reason = "not connected"

    def found(self) -> None:
        """The link is open."""
        self._is_found, self._found_ns = True, self._clock.now_ns()
        self._lines.restart()
        self.base.restart()
        self._lose("waiting for the board's first answer")

    def heard(self, data: bytes) -> None:
        """Take bytes from the link."""
        self._lines.take(data)

    def lost(self, reason: str) -> None:
        """The link is gone."""
        self._is_found = False
        self._lose(reason)

    def tick(self) -> str:
        """Do what the time asks for. Returns why the link should be opened anew, or ''."""
        if not self._is_found:
            return ""
        self._lines.tick()
        self.base.tick()
        self.arm.tick()
        now_ns = self._clock.now_ns()
        if self._lines.timeouts_in_row >= LOST_AFTER_TIMEOUTS:
            self._lose(SILENT)
        elif self.base.is_counting and not self.is_serving:
            self.is_serving, self._reason = True, ""
            self._tell(Health(LinkStatus.RUNNING))
        if self.is_serving:
            self._found_ns = now_ns
        return SILENT if now_ns - self._found_ns > NO_ANSWER_NS else ""

    def halt(self) -> None:
        """Wheels off, as far as somebody hears it."""
        if self._is_found:
            self.base.halt()

    def _lose(self, reason: str) -> None:
        if self.is_serving or reason != self._reason:
            self.is_serving, self._reason = False, reason
            self.base.lose()
            self._tell(Health(LinkStatus.LOST, reason))

    def _require_link(self) -> None:
        if not self.is_serving:
            raise LinkLost(self._reason)
