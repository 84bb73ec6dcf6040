"""The linear experiment beside every trial: its error is known beforehand, so that it takes chance away.

Where measurements are linear, the best estimate misses by G r: r is what went wrong in the trial (taps and
steps, in sigmas) and G is fixed, so that the error is exactly normal, with the Cramér-Rao bound as its
covariance. In the same trial the estimator under test misses by nearly the same. What the two share is
chance, and is subtracted: a control variate (Owen, Monte Carlo theory, methods and examples, 8.9).

Derivatives are differences of the bench's own scene, so that the bound is worked out without the estimator.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from tapreach.bench.accuracy_scene import points_in_cameras, poses_after, project, target_at
from tapreach.bench.accuracy_trials import Drive
from tapreach.geometry.finite import FloatArray

_DELTA = 1e-6


@dataclass(frozen=True)
class Linear:
    """by_target (..., 2n, 3): pixels over sigma by bearing and inverse depth. by_errors (..., 2n, 2(n - 1)):
    by one sigma of every turn, then of every advance. One experiment, or many of equal length.
    """

    by_target: FloatArray
    by_errors: FloatArray

    @cached_property
    def information(self) -> FloatArray:
        """On bearing and inverse depth (..., 3, 3), the step errors marginalised."""
        return np.asarray(np.swapaxes(self._weighted, -1, -2) @ self.by_target)

    @property
    def inverse_depth_sd(self) -> FloatArray:
        """The Cramér-Rao bound on the inverse depth (...) [1/m]."""
        return np.asarray(np.sqrt(np.linalg.inv(self.information)[..., 2, 2]))

    def errors_of(self, chance: FloatArray) -> FloatArray:
        """Return by what the best linear estimate misses (m, 3), from `Trials.chance`; of one experiment."""
        rows = len(self.by_target)
        surprises = chance[:, :rows] + chance[:, rows:] @ self.by_errors.T
        return np.asarray(np.linalg.solve(self.information, self._weighted.T @ surprises.T).T)

    @cached_property
    def _weighted(self) -> FloatArray:
        noise = np.eye(self.by_errors.shape[-2]) + self.by_errors @ np.swapaxes(self.by_errors, -1, -2)
        return np.asarray(np.linalg.solve(noise, self.by_target))


def linear(drive: Drive, target: FloatArray, sigmas: FloatArray, odometry: float) -> Linear:
    """Return the experiment about what the wheels say and the true target (3,), bearing and inverse depth.

    drive: one, or c of them with arrays (c, n - 1). sigmas (n,): of each view [px], infinite for one that is
    not used. odometry: error of every turn and advance, a fraction. Where a target is behind a camera all is
    NaN.
    """
    said = np.atleast_2d(drive.turns), np.atleast_2d(drive.advances)
    count, steps = said[0].shape

    def seen(changes: FloatArray) -> FloatArray:
        """Pixels over sigma (k, c, 2n) after changes (k, 3 + 2(n - 1)): of target, turns and advances."""
        targets = np.repeat(target + changes[:, :3], count, axis=0)
        factors = 1.0 + odometry * np.repeat(changes[:, 3:], count, axis=0)
        turns, advances = (np.tile(each, (len(changes), 1)) for each in said)
        poses = poses_after(turns * factors[:, :steps], advances * factors[:, steps:])
        pixels = project(points_in_cameras(poses, target_at(targets[:, :2], 1.0 / targets[:, 2])))
        return np.asarray((pixels / sigmas[:, None]).reshape(len(changes), count, -1))

    changes = _DELTA * np.eye(3 + 2 * steps)
    by_all = np.moveaxis((seen(changes) - seen(-changes)) / (2.0 * _DELTA), 0, -1)
    by_all = by_all.reshape(*drive.turns.shape[:-1], *by_all.shape[1:])
    return Linear(by_all[..., :3], by_all[..., 3:])
