"""What the background says of one step alone: of the base's way, and of the camera's mount on it.

The pictures tell how the camera turned and which way it went, not how far. In a straight advance that way is
the robot's own forward direction: it shows how the camera stands on the base. Kept as Gaussian information,
the wheels' and the mount's own priors divided out, so that any number of steps can be taken together
(docs/estimation.md, 11).
"""

from dataclasses import dataclass, replace

import numpy as np

from tapreach.estimation.camera_step import PLANAR_ROWS, CameraStep
from tapreach.geometry.finite import FloatArray

PLANAR = 3
"""Errors of a step of the base come first: x, y [m], heading [rad], perturbing on the right."""
HEADING, PITCH = 2, PLANAR + 3
KNOWN = PLANAR + 6
"""Then those of the mount base_from_camera: (translation, rotation), perturbing on the right."""


@dataclass(frozen=True, eq=False)
class StepKnowledge:
    """A likelihood exp(-e' information e / 2 + e' vector) of the errors e (9,) of a step and of the mount.

    information (9, 9), vector (9,): zero for pictures that say nothing. has_slipped: what the wheels say of
    this step is not to be trusted.
    """

    information: FloatArray
    vector: FloatArray
    has_slipped: bool = False


NOTHING_SEEN = StepKnowledge(np.zeros((KNOWN, KNOWN)), np.zeros(KNOWN))


def step_knowledge(
    normals: FloatArray, covariance: FloatArray, step: CameraStep, has_slipped: bool
) -> StepKnowledge:
    """Return what the pictures alone say, from the posterior of the step's unit normals (k,), (k, k).

    Errors that wheels or mount cannot have (no sigma) stay unknown to it, which does no harm: they are not
    looked for.
    """
    by_normal = _errors_by_normals(step)
    told = np.flatnonzero(np.any(by_normal != 0.0, axis=0))
    mean, precision = normals[told], np.linalg.inv(covariance[np.ix_(told, told)])
    learnt = _without_negative(precision - np.eye(len(told)))
    to_normals = np.linalg.pinv(by_normal[:, told])
    information = to_normals.T @ learnt @ to_normals
    vector = to_normals.T @ (mean + learnt @ mean)
    return StepKnowledge((information + information.T) / 2.0, vector, has_slipped)


def loosened(knowledge: StepKnowledge, sigmas: FloatArray) -> StepKnowledge:
    """Return what is known when the pictures may be wrong about e by errors of `sigmas` (9,) in common."""
    unsure = np.flatnonzero(sigmas > 0.0)
    of_unsure = knowledge.information[:, unsure]
    share = np.linalg.solve(np.diag(sigmas[unsure] ** -2.0) + of_unsure[unsure], of_unsure.T).T
    return replace(
        knowledge,
        information=knowledge.information - share @ of_unsure.T,
        vector=knowledge.vector - share @ knowledge.vector[unsure],
    )


def _errors_by_normals(step: CameraStep) -> FloatArray:
    """Return (9, k): the errors of base and mount per unit normal; a rocking chassis has none there."""
    wheels = step.by_wheels.shape[1]
    errors = np.zeros((KNOWN, step.by_normal.shape[1]))
    errors[:PLANAR, :wheels] = np.linalg.solve(step.second_camera_from_base, step.by_wheels)[PLANAR_ROWS]
    errors[PLANAR:, wheels:] = step.mount_root
    # Rounding must not make normals out of nothing.
    errors[np.abs(errors) < 1e-12] = 0.0
    return errors


def _without_negative(information: FloatArray) -> FloatArray:
    """Return it without directions about which less is known than before; widening a spread leaves some."""
    values, vectors = np.linalg.eigh((information + information.T) / 2.0)
    return np.asarray((vectors * np.maximum(values, 0.0)) @ vectors.T)
