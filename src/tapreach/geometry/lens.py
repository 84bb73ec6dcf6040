"""The lens model of OpenCV with five numbers (k1, k2, p1, p2, k3), its derivative and its inverse.

Source: OpenCV, calib3d, "Detailed Description"; Brown, "Decentering distortion of lenses" (1966).
"""

import numpy as np

from tapreach.geometry.finite import FloatArray

Distortion = tuple[float, float, float, float, float]
NO_DISTORTION: Distortion = (0.0, 0.0, 0.0, 0.0, 0.0)

_ITERATIONS = 50
_CONVERGED = 1e-13


def distort(normalised: FloatArray, distortion: Distortion) -> FloatArray:
    """Return where the lens images the ideal points (n, 2) (x/z, y/z): (n, 2), same units."""
    k1, k2, p1, p2, k3 = distortion
    x, y = normalised[:, 0], normalised[:, 1]
    r2 = x * x + y * y
    radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3))
    xd = x * radial + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x)
    yd = y * radial + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y
    return np.stack([xd, yd], axis=1)


def distortion_jacobian(normalised: FloatArray, distortion: Distortion) -> FloatArray:
    """Return the derivative of `distort` with respect to the ideal points: (n, 2, 2)."""
    k1, k2, p1, p2, k3 = distortion
    x, y = normalised[:, 0], normalised[:, 1]
    r2 = x * x + y * y
    radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3))
    slope = 2.0 * (k1 + r2 * (2.0 * k2 + 3.0 * r2 * k3))
    dxx = radial + slope * x * x + 2.0 * p1 * y + 6.0 * p2 * x
    dyy = radial + slope * y * y + 6.0 * p1 * y + 2.0 * p2 * x
    dxy = slope * x * y + 2.0 * p1 * x + 2.0 * p2 * y
    return np.stack([np.stack([dxx, dxy], axis=1), np.stack([dxy, dyy], axis=1)], axis=1)


def undistort(distorted: FloatArray, distortion: Distortion) -> tuple[FloatArray, np.ndarray]:
    """Return the ideal points (n, 2) for imaged points (n, 2), and whether each was found (n,).

    Newton's method with the analytic derivative, run until it stands still. A point the lens cannot image,
    or imaged only from beyond where the model folds back on itself, is reported as not found.
    """
    ideal = distorted.copy()
    if distortion == NO_DISTORTION:
        return ideal, np.ones(len(ideal), dtype=bool)
    with np.errstate(all="ignore"):
        for _ in range(_ITERATIONS):
            error = distort(ideal, distortion) - distorted
            if np.all(np.abs(error) < _CONVERGED):
                break
            ideal = ideal - _solve_2x2(distortion_jacobian(ideal, distortion), error)
        found = np.all(np.abs(distort(ideal, distortion) - distorted) < 1e-9, axis=1)
    found &= np.sum(ideal * ideal, axis=1) < unfolded_radius(distortion) ** 2
    ideal[~found] = 0.0
    return ideal, found


def unfolded_radius(distortion: Distortion) -> float:
    """Return the ideal radius tan(angle off the axis) up to which the radial model grows; may be infinite.

    Beyond it the polynomial turns back and points far outside the field of view seem to fall inside.
    """
    k1, k2, _, _, k3 = distortion
    roots = np.roots([7.0 * k3, 5.0 * k2, 3.0 * k1, 1.0])
    real = roots[np.abs(roots.imag) < 1e-9].real
    above_zero = real[real > 0.0]
    return float(np.sqrt(above_zero.min())) if above_zero.size else float("inf")


def _solve_2x2(matrix: FloatArray, right: FloatArray) -> FloatArray:
    a, b, c, d = matrix[:, 0, 0], matrix[:, 0, 1], matrix[:, 1, 0], matrix[:, 1, 1]
    determinant = a * d - b * c
    first = (d * right[:, 0] - b * right[:, 1]) / determinant
    second = (a * right[:, 1] - c * right[:, 0]) / determinant
    return np.stack([first, second], axis=1)
