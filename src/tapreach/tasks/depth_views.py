"""The pictures of a followed place that are kept for comparing all of them at once."""

from collections.abc import Sequence
from dataclasses import replace
from math import hypot, radians

from tapreach.geometry.planar_motion import PlanarPose
from tapreach.robot.config import RobotDescription
from tapreach.tasks.depth_check import Anchor, Checked, DepthCheck
from tapreach.tasks.depth_search import KeptView
from tapreach.tasks.sighting import Sighting, is_apart
from tapreach.vision.depth_sweep import pyramid_of
from tapreach.vision.image_io import Gray
from tapreach.vision.warp import Warp, scale_of, warp_at

_APART = 0.03, radians(3.0)
_MOST = 20
_NEARER = 1.5
"""A picture in which the place is seen so many times larger than in the one that others are compared with
takes its place.
"""


class DepthViews:
    """first: the tapped frame's sighting, with its picture. At most 20 frames are kept, in order of time, of
    those since the one that they are compared with.
    """

    def __init__(self, picture: Gray, first: Sighting, description: RobotDescription) -> None:
        self._description = description
        self._check = DepthCheck(Anchor.at(picture, warp_at(first.pixel.u, first.pixel.v), 0.0), description)
        self._anchor_scale = 1.0
        self._before: tuple[Sighting, ...] = ()
        """What is believed of the frames before the one that others are compared with."""
        self._views = [KeptView(first, pyramid_of(picture))]

    @property
    def newest(self) -> Sighting:
        """The sighting of the newest frame that is kept, or where it was."""
        return self._views[-1].sighting

    def keep(self, sighting: Sighting, picture: Gray, moved_px: float, is_seen: bool, is_stop: bool) -> None:
        """Keep a frame if it is a stop, if the way to it was measured, or if it lies apart from those kept.

        is_seen: False where the sighting tells nothing but where the frame was taken.
        """
        here = sighting.world_from_base
        if not (is_stop or sighting.way is not None or self._is_apart(here)):
            return
        self._views.append(KeptView(sighting, pyramid_of(picture), moved_px, is_seen))
        if len(self._views) > _MOST:
            del self._views[self._least_missed()]

    def check(self) -> Checked:
        """Return what is to be believed of the sightings so far, and go on from that."""
        checked = self._check.check(self._views)
        believed = replace(checked, sightings=(*self._before, *checked.sightings))
        if checked.layer is not None:
            measured = {sighting.frame_id: sighting for sighting in checked.sightings}
            self._views = [_with(view, measured.get(view.sighting.frame_id)) for view in self._views]
        if checked.newest is not None and scale_of(checked.newest) > _NEARER * self._anchor_scale:
            self._compare_with_newest(checked.newest, believed.sightings)
        return believed

    def _compare_with_newest(self, warp: Warp, believed: Sequence[Sighting]) -> None:
        """Compare what comes with the newest picture, in which the place is at `warp` (2, 3) from the tapped
        patch.
        """
        *before, newest = believed
        view = replace(self._views[-1], sighting=newest)
        self._check = DepthCheck(Anchor.at(view.pyramid[0], warp, newest.sigma), self._description)
        self._anchor_scale = scale_of(warp)
        self._before, self._views = tuple(before), [view]

    def _is_apart(self, here: PlanarPose) -> bool:
        return all(is_apart(view.sighting.world_from_base, here, *_APART) for view in self._views)

    def _least_missed(self) -> int:
        """Return the number of the frame whose neighbours are nearest to each other; keys stay as long as
        others are left, as ways are counted from them.
        """
        poses = [view.sighting.world_from_base for view in self._views]
        spare = [n for n in range(1, len(self._views) - 1) if not self._views[n].sighting.is_key]
        return min(spare or range(1, len(self._views) - 1), key=lambda n: _gap(poses[n - 1], poses[n + 1]))


def _gap(before: PlanarPose, after: PlanarPose) -> float:
    return hypot(after.x - before.x, after.y - before.y) + abs(after.heading - before.heading) * 0.5


def _with(view: KeptView, measured: Sighting | None) -> KeptView:
    """Return the view with its sighting as it was measured again, or as one in which nothing is seen."""
    if measured is None:
        return KeptView(view.sighting, view.pyramid, view.moved_px, is_seen=False)
    if measured.pixel == view.sighting.pixel:  # what could not be confirmed may be so by the next check
        return view
    return KeptView(measured, view.pyramid, view.moved_px)
