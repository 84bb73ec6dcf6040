"""The arm in the robot file: the paper's by its sizes, or another by its chain of joints."""

from math import radians
from typing import Self

from pydantic import Field, model_validator

from tapreach.errors import InputError
from tapreach.geometry.arm_chain import ArmChain, ChainJoint
from tapreach.geometry.arm_clearance import ArmShape
from tapreach.geometry.arm_kinematics import ArmGeometry, ArmKinematics
from tapreach.geometry.chain_arm import ChainArm
from tapreach.robot.messages import ArmPose
from tapreach.robot.section import Finite, Positive, RangeDeg, Section, Vector3
from tapreach.robot.servo_section import ServosSection

Range = tuple[float, float]
_SIZES = ("shoulder_forward", "shoulder_up", "upper_length", "fore_length", "hand_length")


class ArmPoseSection(Section):
    """A pose of the arm by its servos."""

    rotation_deg: Finite = 0.0
    shoulder_deg: Finite
    elbow_deg: Finite
    claw: float = Field(ge=0, description="opening [m]")

    def pose(self) -> ArmPose:
        """Return it in radians."""
        return ArmPose(
            radians(self.rotation_deg), radians(self.shoulder_deg), radians(self.elbow_deg), self.claw
        )


class ChainJointSection(Section):
    """One turning joint, measured in the base frame while all servos stand at 0."""

    axis: Vector3 = Field(description="along the axis; turning about it by the right hand is positive")
    offset: Vector3 = Field(description="from the joint before, for the first from the base's origin [m]")


class ChainSection(Section):
    """An arm that is not the paper's, as the joints of servos A, B and C in a row.

    Three, since three are what a robot is sent (besides the claw). Their limits stand in [arm].
    """

    joints: tuple[ChainJointSection, ChainJointSection, ChainJointSection]
    wrist: Vector3 = Field(description="from joint C to the wrist, all servos at 0 [m]")
    hand: Vector3 = Field(description="from the wrist to the middle between the finger tips [m]")
    hand_is_level: bool = Field(
        True, description="a linkage lets the hand turn with A alone; else it goes with the forearm"
    )

    def arm(self, ranges: tuple[Range, Range, Range]) -> ChainArm:
        """Return the solver for these ranges of the joints [rad]. Raises InputError."""
        pairs = zip(self.joints, ranges, strict=True)
        joints = tuple(ChainJoint(joint.axis, joint.offset, *within) for joint, within in pairs)
        return ChainArm(ArmChain(joints, self.wrist, self.hand, self.hand_is_level))


class ArmSection(Section):
    """The paper's arm: A turns it, B and C move it in a plane, a linkage keeps it level, D is the claw.

    An arm that is built otherwise has [arm.chain] in place of shoulder_*, upper_length, fore_length and
    hand_length.
    """

    shoulder_forward: Finite | None = Field(
        None, description="axis of B ahead of the wheel axis [m]; on the axis of A"
    )
    shoulder_left: Finite = Field(0.0, description="axis of A left of the middle [m]")
    shoulder_up: Positive | None = Field(None, description="axis of B above the floor [m]")
    upper_length: Positive | None = Field(None, description="axis of B to axis of C [m]")
    fore_length: Positive | None = Field(None, description="axis of C to the wrist [m]")
    hand_length: Positive | None = Field(None, description="wrist to the middle between the finger tips [m]")
    chain: ChainSection | None = None
    claw_max: Positive = Field(description="widest opening [m]")
    link_radius: Positive = Field(0.016, description="half the thickness of upper arm and forearm [m]")
    hand_radius: Positive = Field(0.011, description="half the height of hand and fingers [m]")
    palm_width: float = Field(0.06, ge=0, description="of the hand at the wrist, across [m]")
    finger_thickness: Positive = Field(0.006, description="of one finger, across [m]")
    finger_beyond: float = Field(
        0.025, ge=0, description="how far the fingers reach beyond the middle between their tips [m]"
    )
    rotation_limits_deg: RangeDeg
    shoulder_limits_deg: RangeDeg
    elbow_limits_deg: RangeDeg
    speed_deg_s: Positive = Field(140.0, description="fastest servo speed")
    servos: ServosSection | None = Field(None, description="pulses; needed by driver 'arduino'")
    standard: ArmPoseSection = Field(description="pose for locating: out of the picture")
    stowed: ArmPoseSection = Field(description="pose for driving: out of the picture, folded")

    def kinematics(self) -> ArmKinematics:
        """Return the closed form of the paper's arm, or the solver of the chain."""
        limits = (self.rotation_limits_deg, self.shoulder_limits_deg, self.elbow_limits_deg)
        a, b, c = ((radians(low), radians(high)) for low, high in limits)
        if self.chain is not None:
            return self.chain.arm((a, b, c))
        forward, up, upper, fore, hand = (getattr(self, name) for name in _SIZES)
        return ArmGeometry((forward, self.shoulder_left, up), upper, fore, hand, a, b, c)

    @property
    def joint_speed(self) -> float:
        """Fastest speed of the servos [rad/s]."""
        return radians(self.speed_deg_s)

    def shape(self) -> ArmShape:
        """Return how thick it is."""
        return ArmShape(
            self.link_radius, self.hand_radius, self.finger_beyond, self.finger_thickness, self.palm_width
        )

    @model_validator(mode="after")
    def _is_described_once(self) -> Self:
        given = [name for name in _SIZES if getattr(self, name) is not None]
        missing = [name for name in _SIZES if name not in given]
        if self.chain is None and missing:
            raise ValueError(f"{', '.join(missing)} missing: give these sizes, or the joints as [arm.chain]")

        if self.chain is not None and given:
            raise ValueError(f"with [arm.chain] leave out {', '.join(given)}: the chain says it")
        try:
            self.kinematics()
        except InputError as error:
            raise ValueError(str(error)) from None
        return self
