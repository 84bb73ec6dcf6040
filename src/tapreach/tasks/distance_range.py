"""Which distances of a target its sightings so far leave possible: they bound where it can be seen next."""

import numpy as np

from tapreach.geometry.finite import FloatArray
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.robot.config import RobotDescription
from tapreach.tasks.guessing import guess_sigma, may_be_on
from tapreach.tasks.optics import optics_of, points_in_camera
from tapreach.tasks.sighting import Sighting, is_apart, ray_of
from tapreach.vision.track import Guess

_GRID = np.geomspace(0.15, 12.0, 45)
_MISFIT = 16.0
"""What a distance may fit worse than the best one: four sigma."""
_APART = 0.02, 0.035
_MOST_SIGHTINGS = 8
_GUESSES = 9


class DistanceRange:
    """Distances along the line of sight of the `first` sighting, narrowed by each later one."""

    def __init__(self, first: Sighting, description: RobotDescription) -> None:
        self._description = description
        ray = ray_of(first, description)
        self._points = np.stack([ray.at(float(distance)) for distance in _GRID])
        self._kept: list[tuple[Sighting, FloatArray]] = []
        self._first = self._last = first
        self._is_possible = np.ones(len(_GRID), dtype=bool)
        self._best = int(np.argmin(np.abs(_GRID - 1.0)))

    def note(self, sighting: Sighting) -> None:
        """Take a later sighting; one from almost the same place as the one before changes nothing."""
        if not is_apart(self._last.world_from_base, sighting.world_from_base, *_APART):
            return
        self._last = sighting
        self._kept.append((sighting, self._misfits(sighting)))
        if len(self._kept) > _MOST_SIGHTINGS:
            self._kept = self._kept[1::2]
        total = np.sum([misfits for _, misfits in self._kept], axis=0)
        self._best = int(np.argmin(total))
        self._is_possible = total <= total[self._best] + _MISFIT

    def guesses(self, last: Sighting, world_from_base: PlanarPose) -> tuple[Guess, ...]:
        """Return where the target falls in a frame taken at `world_from_base`, the likeliest guess first.

        Each is the mean of what the first and the last sighting lead to, weighted by how sure they are: what
        was followed wrong for a while is not believed for ever. No guess at all means that it cannot be in
        the picture.
        """
        points = self._points[self._chosen()]
        now, depths = self._seen_from(points, world_from_base)
        before, depths_before = self._seen_from(points, last.world_from_base)
        is_valid = (depths > 0.0) & (depths_before > 0.0)
        nearer = np.where(is_valid, depths_before, 1.0) / np.where(is_valid, depths, 1.0)
        by_last = now + (last.pixel.to_array() - before) * nearer[:, None]
        last_sigma = guess_sigma(
            last.sigma * np.maximum(nearer, 1.0), now - before, nearer, self._description
        )
        first_sigma = self._sigma_by_first(points, now, depths)
        share = (first_sigma**2 / (first_sigma**2 + last_sigma**2))[:, None]
        pixels = share * by_last + (1.0 - share) * now
        sigmas = np.minimum(first_sigma, last_sigma)
        if not np.any(is_valid & may_be_on(optics_of(self._description.camera)[0].size, pixels, sigmas)):
            return ()
        return tuple(
            Guess(float(u), float(v), last.scale * float(ratio), float(sigma))
            for (u, v), ratio, sigma in zip(pixels[is_valid], nearer[is_valid], sigmas[is_valid], strict=True)
        )

    def _chosen(self) -> list[int]:
        (possible,) = np.nonzero(self._is_possible)
        spread = np.linspace(max(possible[0] - 1, 0), min(possible[-1] + 1, len(_GRID) - 1), _GUESSES)
        return [self._best, *sorted({round(float(index)) for index in spread} - {self._best})]

    def _sigma_by_first(self, points: FloatArray, pixels: FloatArray, depths: FloatArray) -> FloatArray:
        """Return one sigma [px] (n,) of where `points` (n, 3) are expected by the first sighting alone."""
        moved = pixels - self._first.pixel.to_array()
        _, before = self._seen_from(points, self._first.world_from_base)
        nearer = np.where(depths > 0.0, before, 1.0) / np.where(depths > 0.0, depths, 1.0)
        return guess_sigma(self._first.sigma, moved, nearer, self._description)

    def _seen_from(self, points: FloatArray, world_from_base: PlanarPose) -> tuple[FloatArray, FloatArray]:
        """Return pixels (n, 2) and depths (n,) [m] of points; a depth of 0 says that it is not seen."""
        in_camera = points_in_camera(points, world_from_base, self._description.camera)
        projection = optics_of(self._description.camera)[0].project(in_camera)
        return projection.pixels, np.where(projection.is_valid, in_camera[:, 2], 0.0)

    def _misfits(self, sighting: Sighting) -> FloatArray:
        """Return the squared error over its variance for each distance (n,); unseen is very bad."""
        pixels, depths = self._seen_from(self._points, sighting.world_from_base)
        errors = np.linalg.norm(pixels - sighting.pixel.to_array(), axis=1)
        sigmas = np.hypot(sighting.sigma, self._sigma_by_first(self._points, pixels, depths))
        return np.where(depths > 0.0, np.minimum(errors**2 / sigmas**2, 1e4), 1e4)
