"""An arm chain of three joints under the names of the servos A, B and C."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tapreach.errors import InputError
from tapreach.geometry.arm_chain import ArmChain
from tapreach.geometry.arm_kinematics import ArmJoints, Reach, ReachStatus, within_ranges
from tapreach.geometry.chain_inverse import solve_chain
from tapreach.geometry.finite import FloatArray, finite_array


@dataclass(frozen=True)
class ChainArm:
    """See ArmKinematics: its joints are rotation, shoulder and elbow, in this order from the base outwards.

    Raises InputError for a chain of more or fewer joints.
    """

    chain: ArmChain

    def __post_init__(self) -> None:
        if len(self.chain.joints) != 3:
            raise InputError(
                f"the chain has {len(self.chain.joints)} joints; servos A, B and C make it exactly 3"
            )

    def forward(self, joints: ArmJoints) -> FloatArray:
        """See ArmKinematics."""
        tip: FloatArray = self.skeleton(joints)[-1]
        return tip

    def skeleton(self, joints: ArmJoints) -> FloatArray:
        """See ArmKinematics: joints A, B, C, wrist and tip, (5, 3)."""
        return self.chain.skeleton(_angles(joints))

    def inverse(self, tip_in_base: npt.ArrayLike, near: ArmJoints | None = None) -> Reach:
        """See ArmKinematics. Numeric, to a micrometre; of several solutions the one found from `near`."""
        goal = finite_array("tip_in_base", tip_in_base, (3,))
        start = None if near is None else _angles(near)
        found = solve_chain(self.chain, goal, start)
        if found.is_there:
            return Reach(ReachStatus.REACHABLE, "within reach", _joints(found.angles), 0.0)
        free = solve_chain(self.chain, goal, found.angles, is_free=True)
        if free.is_there:
            first, second, third = ((float(low), float(high)) for low, high in self.chain.ranges)
            return within_ranges(_joints(free.angles), (first, second, third))
        return _out_of_reach(self.chain, goal, free.angles, free.distance)


def _out_of_reach(chain: ArmChain, goal: FloatArray, angles: FloatArray, missing: float) -> Reach:
    points = chain.skeleton(angles)
    is_far = np.linalg.norm(goal - points[0]) > np.linalg.norm(points[-1] - points[0])
    if is_far:
        return Reach(ReachStatus.TOO_FAR, f"{100.0 * missing:.1f} cm beyond reach", None, missing)
    return Reach(ReachStatus.TOO_NEAR, f"{100.0 * missing:.1f} cm too near", None, missing)


def _angles(joints: ArmJoints) -> tuple[float, float, float]:
    return joints.rotation, joints.shoulder, joints.elbow


def _joints(angles: FloatArray) -> ArmJoints:
    rotation, shoulder, elbow = (float(angle) for angle in angles)
    return ArmJoints(rotation, shoulder, elbow)
