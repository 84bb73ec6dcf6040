"""Where the servos of an arm really stand, from places of its claw seen in a few poses.

Unknown are the zeros of servos A, B, C, the camera's mount (a nuisance: zeros and mount cannot be told
apart well, and need not be) and how much wider the claw opens than it should. What comes out surely is where
the claw is in the camera's frame, in which the thing to be gripped is seen too. Maximum a posteriori by
Gauss-Newton; the play of the gears is noise that all places of one pose share.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial.transform import RigidTransform

from tapreach.estimation.claw_sight import UNKNOWNS, ArmNoise, ClawView, SightModel
from tapreach.geometry.arm_kinematics import ArmJoints, ArmKinematics
from tapreach.geometry.camera import Camera
from tapreach.geometry.finite import FloatArray
from tapreach.geometry.pose import perturbed

_ITERATIONS = 12
_RESTS = 1e-4
"""A step below this share of one sigma is none."""
_OUTLYING = 4.0
"""A place so many sigma off is not the claw's."""
_MOST_LEFT_OUT = 1.0 / 3.0
_LEAST_PLACES = 4
_TIP = np.zeros((1, 3)), np.zeros(1)


@dataclass(frozen=True)
class NoOffsets:
    """Why the arm's zeros cannot be told."""

    reason: str


@dataclass(frozen=True, eq=False)
class ArmOffsets:
    """The arm as it was seen.

    arm, filed_mount: by the robot's file. unknowns (10,): how far they are off (SightModel), with their
    covariance (10, 10): each alone is poorly known, what follows for the claw in the camera's frame is not.
    play: one sigma of a joint from pose to pose [rad]. rms: of what is left, in sigmas. used, left_out: how
    many places.
    """

    arm: ArmKinematics
    filed_mount: RigidTransform
    unknowns: FloatArray
    covariance: FloatArray
    play: float
    rms: float
    used: int
    left_out: int

    @property
    def zeros(self) -> FloatArray:
        """Return what is to be added to what the servos are sent, (3,) [rad]."""
        return self.unknowns[:3]

    @property
    def base_from_camera(self) -> RigidTransform:
        """Return the mount that goes with the zeros."""
        return perturbed(self.filed_mount, self.unknowns[3:9])

    def tip_in_camera(self, sent: ArmJoints) -> FloatArray:
        """Return where the point between the finger tips is, (3,) in the camera's frame [m]."""
        tip: FloatArray = self._model.in_camera(self.unknowns, sent, *_TIP)[0]
        return tip

    def tip_cov_in_camera(self, sent: ArmJoints) -> FloatArray:
        """Return its covariance (3, 3) [m²], the play of the next move included."""
        by_unknowns = self._model.by_unknowns(self.unknowns, sent, *_TIP)[0]
        by_play = self.play * by_unknowns[:, :3]
        return np.asarray(by_unknowns @ self.covariance @ by_unknowns.T + by_play @ by_play.T)

    @property
    def _model(self) -> SightModel:
        return SightModel(self.arm, self.filed_mount)


def estimate_arm_offsets(
    views: Sequence[ClawView],
    arm: ArmKinematics,
    camera: Camera,
    base_from_camera: RigidTransform,
    noise: ArmNoise,
) -> ArmOffsets | NoOffsets:
    """Return the zeros that agree best with what was seen of the claw.

    A place far off what all others say is left out. NoOffsets when there are fewer than four places, when
    more than a third of them would have to be left out, or when one falls behind the camera.
    """
    kept = [view for view in views if view.places]
    given = sum(len(view.places) for view in kept)
    if given < _LEAST_PLACES:
        return NoOffsets(f"the claw was seen in {given} places; at least {_LEAST_PLACES} are needed")
    model = SightModel(arm, base_from_camera)
    for left_out in range(int(given * _MOST_LEFT_OUT) + 1):
        fit = _fitted(kept, model, camera, noise)
        if fit is None:
            return NoOffsets("the claw was seen where this arm, before this camera, cannot bring it")
        if fit.distances.max() <= _OUTLYING:
            return _offsets(fit, model, noise, left_out)
        kept = _without(kept, int(np.argmax(fit.distances)))
    return NoOffsets("the places in which the claw was seen do not agree with each other")


@dataclass(frozen=True, eq=False)
class _Fit:
    """unknowns (10,), covariance (10, 10), and how far each place is off (n,) [sigmas]."""

    unknowns: FloatArray
    covariance: FloatArray
    distances: FloatArray


def _fitted(views: Sequence[ClawView], model: SightModel, camera: Camera, noise: ArmNoise) -> _Fit | None:
    prior, unknowns = noise.prior(), np.zeros(UNKNOWNS)
    for _ in range(_ITERATIONS):
        information, pull = np.diag(prior**-2.0), -unknowns / prior**2
        for view in views:
            line = model.linearised(view, unknowns, camera)
            if line is None:
                return None
            information, pull = _added(information, pull, *line, _noise_of(view, line[1], noise))
        step = np.linalg.solve(information, pull)
        unknowns = unknowns + step
        if np.all(np.abs(step) < _RESTS * prior):
            break
    distances = _distances(views, unknowns, model, camera, noise)
    if distances is None:
        return None
    return _Fit(np.asarray(unknowns), np.asarray(np.linalg.inv(information)), distances)


def _added(
    information: FloatArray, pull: FloatArray, residual: FloatArray, jacobian: FloatArray, cov: FloatArray
) -> tuple[FloatArray, FloatArray]:
    rows = jacobian.reshape(-1, UNKNOWNS)
    weighted = np.linalg.solve(cov, rows).T
    return information + weighted @ rows, pull + weighted @ residual.ravel()


def _noise_of(view: ClawView, jacobian: FloatArray, noise: ArmNoise) -> FloatArray:
    """Return the covariance (2n, 2n) [px²] of a view's places, which share the play of the gears."""
    by_play = noise.play * jacobian[:, :, :3].reshape(-1, 3)
    own = np.repeat([place.sigma for place in view.places], 2)
    return np.asarray(np.diag(own**2) + by_play @ by_play.T)


def _distances(
    views: Sequence[ClawView], unknowns: FloatArray, model: SightModel, camera: Camera, noise: ArmNoise
) -> FloatArray | None:
    found = []
    for view in views:
        line = model.linearised(view, unknowns, camera)
        if line is None:
            return None
        cov = _noise_of(view, line[1], noise)
        for i, residual in enumerate(line[0]):
            own = cov[2 * i : 2 * i + 2, 2 * i : 2 * i + 2]
            found.append(np.sqrt(residual @ np.linalg.solve(own, residual) / 2.0))
    return np.array(found)


def _without(views: Sequence[ClawView], place: int) -> list[ClawView]:
    """Return the views without their place of this number, counted through all of them."""
    kept = []
    for view in views:
        places = (
            view.places[:place] + view.places[place + 1 :] if 0 <= place < len(view.places) else view.places
        )
        place -= len(view.places)
        if places:
            kept.append(replace(view, places=places))
    return kept


def _offsets(fit: _Fit, model: SightModel, noise: ArmNoise, left_out: int) -> ArmOffsets:
    return ArmOffsets(
        arm=model.arm,
        filed_mount=model.base_from_camera,
        unknowns=fit.unknowns,
        covariance=fit.covariance,
        play=noise.play,
        rms=float(np.sqrt(np.mean(fit.distances**2))),
        used=len(fit.distances),
        left_out=left_out,
    )
