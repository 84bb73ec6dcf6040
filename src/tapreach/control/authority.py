"""Who has a say right now: lease, presence, emergency stop and the robot's health in one place."""

from tapreach.control.deadman import Deadman
from tapreach.control.emergency_stop import EmergencyStop
from tapreach.control.gate import Circumstances
from tapreach.control.lease import Lease
from tapreach.robot.clock import Clock
from tapreach.robot.interface import Robot


class Authority:
    """The parts that the gate asks, and the questions it asks them."""

    def __init__(
        self, robot: Robot, clock: Clock, lease: Lease, deadman: Deadman, emergency_stop: EmergencyStop
    ) -> None:
        self.robot = robot
        self.clock = clock
        self.lease = lease
        self.deadman = deadman
        self.emergency_stop = emergency_stop

    def circumstances_of(self, session_id: int | None) -> Circumstances:
        """Return what counts for something that this session wants, or answers for."""
        return Circumstances(
            now_ns=self.clock.now_ns(),
            health=self.robot.health,
            emergency_stop=self.emergency_stop.text,
            has_lease=session_id is not None and self.lease.is_held_by(session_id),
            operator_is_alive=self.deadman.is_alive,
        )

    def circumstances_of_holder(self) -> Circumstances:
        """Return what counts for the wish of whoever holds the lease."""
        return self.circumstances_of(self.lease.status.holder_id)
