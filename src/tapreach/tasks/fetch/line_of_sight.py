"""What the arm's own links hide from the camera."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from tapreach.geometry.arm_clearance import Capsule
from tapreach.geometry.finite import FloatArray

_ALONG = np.linspace(0.2, 0.99, 28)


def is_hidden(eye: FloatArray, places: FloatArray, capsules: Sequence[Capsule]) -> NDArray[np.bool_]:
    """Tell of places (n, 3) whether a capsule is between them and the eye (3,), all in the base frame."""
    hidden = np.zeros(len(places), dtype=bool)
    lines = eye + _ALONG[None, :, None] * (places - eye)[:, None, :]
    for capsule in capsules:
        way = capsule.end - capsule.start
        share = np.clip((lines - capsule.start) @ way / float(way @ way), 0.0, 1.0)
        nearest = capsule.start + share[..., None] * way
        hidden |= (np.linalg.norm(lines - nearest, axis=2) < capsule.radius).any(axis=1)
    return hidden
