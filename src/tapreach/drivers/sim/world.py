"""The physics of the robot in its scene: pure, stepped by whoever owns it, no pictures, no clock."""

import math
from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

from tapreach.drivers.sim.board import CONTROL_PERIOD_S, DriveBoard, Servo
from tapreach.drivers.sim.build import build_model
from tapreach.drivers.sim.encoders import Encoders
from tapreach.drivers.sim.faults import SimFaults
from tapreach.drivers.sim.scene import Scene
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.robot.config import RobotDescription
from tapreach.robot.messages import ArmPose, Twist

JOINTS = ("rotation", "shoulder", "elbow", "claw")
SERVO_RESOLUTION = math.radians(0.18)
CLAW_RAD_PER_METRE = 20.0
SETTLE_S = 0.4


@dataclass(frozen=True, slots=True)
class BoardState:
    """What the board can tell: simulated time [s] since start, ticks, servos where sent, and its deadman."""

    time_s: float
    ticks: tuple[int, int]
    arm: ArmPose
    arm_target: ArmPose
    arm_is_moving: bool
    needs_zero: bool


class World:
    """Robot and room. Equal scene, description, faults, seed and commands give equal motion."""

    def __init__(self, scene: Scene, description: RobotDescription, faults: SimFaults, seed: int = 0) -> None:
        self.description = description
        self.model = build_model(scene, description.camera, faults)
        self.data = mujoco.MjData(self.model)
        self.object_names = scene.object_names()
        base = description.base
        board_base = base
        if faults.encoder_ticks_per_turn:
            board_base = base.model_copy(update={"ticks_per_turn": faults.encoder_ticks_per_turn})
        self._board = DriveBoard(board_base)
        self._encoders = Encoders(base.ticks_per_turn, base.wheel_radius, faults, seed)
        self._servos = _make_servos(description, faults)
        self._steps_per_period = round(CONTROL_PERIOD_S / self.model.opt.timestep)
        self._ticks = (0, 0)
        self._wheels = [self.model.joint(f"wheel_{side}").qposadr[0] for side in ("left", "right")]
        self._motors = [self.model.actuator(f"motor_{side}").id for side in ("left", "right")]
        self._servo_ids = [self.model.actuator(f"servo_{name}").id for name in JOINTS]
        self._settle()
        self._start_s = float(self.data.time)

    @property
    def period_s(self) -> float:
        """Simulated time of one `step` [s]."""
        return CONTROL_PERIOD_S

    @property
    def warnings(self) -> list[str]:
        """Return what MuJoCo warned of so far: then the state is not to be trusted."""
        counts = self.data.warning.number
        return [
            f"the physics reported {mujoco.mjtWarning(int(index)).name} ({counts[index]} times)"
            for index in np.flatnonzero(counts)
        ]

    def drive(self, twist: Twist) -> None:
        """Hand the board a twist, as a message from the host does."""
        self._board.command(twist)

    def move_arm(self, target: ArmPose) -> None:
        """Send the servos to `target` at their speed. Limits are the host's task; the joints have stops."""
        for servo, angle in zip(self._servos, _servo_angles(target), strict=True):
            servo.target = angle

    def step(self) -> None:
        """Advance by one control period of the board (10 ms)."""
        volts = self._board.control(self._ticks)
        self.data.ctrl[self._motors] = volts
        for actuator, servo in zip(self._servo_ids, self._servos, strict=True):
            self.data.ctrl[actuator] = servo.step(CONTROL_PERIOD_S)
        mujoco.mj_step(self.model, self.data, self._steps_per_period)
        self._ticks = self._encoders.read(*(float(self.data.qpos[i]) for i in self._wheels))

    def board_state(self) -> BoardState:
        """Return what the board can tell now."""
        return BoardState(
            time_s=float(self.data.time) - self._start_s,
            ticks=self._ticks,
            arm=_arm_pose([servo.position for servo in self._servos]),
            arm_target=_arm_pose([servo.target for servo in self._servos]),
            arm_is_moving=any(servo.is_moving for servo in self._servos),
            needs_zero=self._board.needs_zero,
        )

    def place_base(self, pose: PlanarPose) -> None:
        """Lift the robot to `pose` in the scene, at rest; wheels and encoders do not notice."""
        start = self.model.joint("base").qposadr[0]
        upright = _without_heading(self.data.qpos[start + 3 : start + 7])
        turn = np.array([math.cos(pose.heading / 2), 0.0, 0.0, math.sin(pose.heading / 2)])
        self.data.qpos[start : start + 2] = pose.x, pose.y
        mujoco.mju_mulQuat(self.data.qpos[start + 3 : start + 7], turn, upright)
        self.data.qvel[self.model.joint("base").dofadr[0] :][:6] = 0.0
        mujoco.mj_forward(self.model, self.data)

    def snapshot(self) -> NDArray[np.float64]:
        """Return the state that a picture needs, as one vector: cheap to copy to another thread."""
        return np.array(self.data.qpos)

    def _settle(self) -> None:
        """Put the arm in its stowed pose and let everything come to rest on the floor."""
        for name, servo in zip(JOINTS[:3], self._servos[:3], strict=True):
            self.data.qpos[self.model.joint(name).qposadr[0]] = servo.position
        level = -(self._servos[1].position + self._servos[2].position)
        self.data.qpos[self.model.joint("wrist").qposadr[0]] = level
        for finger in ("finger_left", "finger_right"):
            self.data.qpos[self.model.joint(finger).qposadr[0]] = (
                self._servos[3].position / CLAW_RAD_PER_METRE / 2
            )
        mujoco.mj_forward(self.model, self.data)
        for _ in range(round(SETTLE_S / CONTROL_PERIOD_S)):
            self.step()
        self._place_at_start()

    def _place_at_start(self) -> None:
        """Undo the hair's breadth that settling moved the base: the world frame is where it starts."""
        start = self.model.joint("base").qposadr[0]
        self.data.qpos[start : start + 2] = 0.0
        self.data.qpos[start + 3 : start + 7] = _without_heading(self.data.qpos[start + 3 : start + 7])
        mujoco.mj_forward(self.model, self.data)


def _make_servos(description: RobotDescription, faults: SimFaults) -> list[Servo]:
    start = _servo_angles(description.arm.stowed.pose())
    speed = math.radians(description.arm.speed_deg_s)
    offset, play = math.radians(faults.servo_offset_deg), math.radians(faults.servo_backlash_deg)
    servos = [Servo(speed, SERVO_RESOLUTION, angle, offset, play) for angle in start[:3]]
    return [*servos, Servo(speed, SERVO_RESOLUTION, start[3])]


def _servo_angles(pose: ArmPose) -> tuple[float, float, float, float]:
    return pose.rotation, pose.shoulder, pose.elbow, pose.claw * CLAW_RAD_PER_METRE


def _arm_pose(angles: list[float]) -> ArmPose:
    return ArmPose(angles[0], angles[1], angles[2], angles[3] / CLAW_RAD_PER_METRE)


def _without_heading(quat_wxyz: NDArray[np.float64]) -> NDArray[np.float64]:
    w, x, y, z = quat_wxyz
    half = 0.5 * math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
    turn_back = np.array([math.cos(half), 0.0, 0.0, -math.sin(half)])
    result = np.zeros(4)
    mujoco.mju_mulQuat(result, turn_back, quat_wxyz)
    return result
