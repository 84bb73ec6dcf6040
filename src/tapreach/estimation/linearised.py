"""The views linearised about some x, and the pose errors eliminated (docs/estimation.md, 6).

There are fewer residuals than pose errors, so that the elimination is done on the side of the residuals: with
C = I + Jz Jzᵀ the information on the target is Jtᵀ C⁻¹ Jt, equal to the Schur complement of all the unknowns.
"""

from dataclasses import dataclass, fields
from functools import cached_property

import numpy as np
import numpy.typing as npt
from scipy.linalg.lapack import dpotrf, dpotrs, dtrtri

from tapreach.geometry.finite import FloatArray

Index = npt.NDArray[np.intp] | npt.NDArray[np.bool_]


@dataclass(frozen=True)
class Linearised:
    """m points x (m, 3 + k): residuals over sigma (m, 2n), and their derivatives by (a, b, rho) (m, 2n, 3)
    and by z (m, 2n, k).

    is_in_front (m,): whether all views used have the target before them; where not, nothing else means much.
    """

    x: FloatArray
    residuals: FloatArray
    by_target: FloatArray
    by_errors: FloatArray
    is_in_front: npt.NDArray[np.bool_]

    @cached_property
    def costs(self) -> FloatArray:
        """(m,): squared residuals over sigma plus |z|², equation (6); infinite where not in front."""
        normals = self.x[:, 3:]
        if len(normals) == 1:
            cost = self.residuals[0] @ self.residuals[0] + normals[0] @ normals[0]
            return np.array([cost if self.is_in_front[0] else np.inf])
        costs = np.sum(self.residuals * self.residuals, axis=1) + np.sum(normals * normals, axis=1)
        return np.where(self.is_in_front, costs, np.inf)

    def noise(self, damping: FloatArray | None = None) -> FloatArray:
        """Return C (m, 2n, 2n), the covariance of the residuals with the pose errors in it; damping (m,)."""
        covariance = self.by_errors @ np.swapaxes(self.by_errors, 1, 2)
        if damping is not None and damping.any():
            covariance /= (1.0 + damping)[:, None, None]
        rows = covariance.shape[1]
        covariance.reshape(len(covariance), rows * rows)[:, :: rows + 1] += 1.0
        return np.asarray(covariance)

    def solved(self, right: FloatArray, damping: FloatArray | None = None) -> FloatArray:
        """Return C⁻¹ right (m, 2n, r)."""
        if self.by_errors.shape[2] == 0:
            return right
        noise = self.noise(damping)
        return np.asarray(np.linalg.solve(noise, right), dtype=np.float64)

    @cached_property
    def factor(self) -> FloatArray:
        """The lower Cholesky factor of C (2n, 2n) of a single point; C ≥ I is far from singular."""
        by_errors = self.by_errors[0]
        noise = by_errors @ by_errors.T
        noise.ravel()[:: len(noise) + 1] += 1.0
        return np.asarray(dpotrf(noise, lower=1)[0])

    def weighed(self, right: FloatArray) -> FloatArray:
        """Return C⁻¹ right (2n, r) of a single point, for few r."""
        return right if self.by_errors.shape[2] == 0 else np.asarray(dpotrs(self.factor, right, lower=1)[0])

    @cached_property
    def weighed_rows(self) -> tuple[FloatArray, FloatArray]:
        """(Jt, e) and C⁻¹ (Jt, e), (2n, 4) each, of a single point; e = r − Jz z."""
        by_errors = self.by_errors[0]
        rows = np.empty((len(by_errors), 4))
        rows[:, :3], rows[:, 3] = self.by_target[0], self.residuals[0] - by_errors @ self.x[0, 3:]
        return rows, self.weighed(rows)

    @cached_property
    def pull(self) -> FloatArray:
        """C⁻¹ Jt (2n, 3) of a single point."""
        return self.weighed_rows[1][:, :3]

    @cached_property
    def unfactored(self) -> FloatArray:
        """The inverse (2n, 2n) of the factor of a single point, so that its own product is C⁻¹."""
        # LAPACK's own way to C⁻¹ (potri, potrs with many columns) starts threads for the smallest matrices.
        return np.asarray(dtrtri(self.factor, lower=1)[0])

    def on_target(self) -> FloatArray:
        """Return the information (m, 3, 3) on (a, b, rho), the pose errors marginalised: equation (7)."""
        if len(self.x) == 1:
            return np.asarray(self.by_target[0].T @ self.pull)[None]
        return np.asarray(np.swapaxes(self.by_target, 1, 2) @ self.solved(self.by_target))

    def log_information_without_depth(self) -> FloatArray:
        """Return the logarithm (m,) of the determinant of the information on all unknowns but rho."""
        noise = self.noise()
        bearing = self.by_target[..., :2]
        on_bearing = np.swapaxes(bearing, 1, 2) @ np.linalg.solve(noise, bearing)
        return np.asarray(np.linalg.slogdet(noise)[1] + np.linalg.slogdet(on_bearing)[1])

    def moved(self, step: FloatArray) -> "Linearised":
        """Return a single point moved by a step (3 + k,) over which the views may be taken as linear."""
        residuals = self.residuals + self.by_target[0] @ step[:3] + self.by_errors[0] @ step[3:]
        moved = Linearised(self.x + step, residuals, self.by_target, self.by_errors, self.is_in_front)
        vars(moved).update(factor=self.factor, pull=self.pull)  # made of the derivatives alone
        return moved

    def take(self, index: Index) -> "Linearised":
        """Return some of the m points."""
        return Linearised(*(getattr(self, each)[index] for each in _FIELDS))

    def updated(self, other: "Linearised", where: npt.NDArray[np.bool_]) -> "Linearised":
        """Return this one with those points of `other` (m as well) where (m,) says so."""
        return self.replaced(np.flatnonzero(where), other.take(where))

    def replaced(self, index: Index, part: "Linearised") -> "Linearised":
        """Return this one with the points at `index` replaced by those of `part`."""
        if len(part.x) == len(self.x):
            return part
        copies = {each: getattr(self, each).copy() for each in _FIELDS}
        for each, values in copies.items():
            values[index] = getattr(part, each)
        return Linearised(**copies)


_FIELDS = tuple(each.name for each in fields(Linearised))
