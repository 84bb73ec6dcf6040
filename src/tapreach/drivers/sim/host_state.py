"""The host's view of the simulated board: arm state."""

from tapreach.drivers.sim.protocol import Telemetry
from tapreach.robot.messages import ArmPose, ArmState


def arm_state(telemetry: Telemetry) -> ArmState:
    """Return the arm's part of a telemetry."""
    t = telemetry
    return ArmState(
        t.captured_ns,
        ArmPose(t.rotation, t.shoulder, t.elbow, t.claw),
        ArmPose(t.target_rotation, t.target_shoulder, t.target_elbow, t.target_claw),
        t.arm_is_moving,
    )
