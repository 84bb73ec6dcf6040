"""Which pictures are looked at once the thing is out of them."""

from dataclasses import dataclass, field

from hypothesis import given
from hypothesis import strategies as st

from tapreach.estimation.pose_history import PoseHistory
from tapreach.geometry.pixel import ImageSize, Pixel
from tapreach.geometry.planar_motion import PlanarPose, PlanarStep
from tapreach.robot.clock import MS
from tapreach.robot.frame_store import FrameStore
from tapreach.robot.messages import Frame
from tapreach.tasks.delay_kept import DelayKept
from tapreach.tasks.fetch.later_pictures import later_pictures
from tapreach.tasks.sighting import Sighting, is_apart

SIZE = ImageSize(640, 480)
steps = st.lists(st.builds(PlanarStep, st.floats(-0.3, 0.3), st.floats(0.0, 0.06)), min_size=1, max_size=30)


@dataclass
class Kept:
    """What of a context tells where pictures were taken."""

    frames: FrameStore = field(default_factory=FrameStore)
    poses: PoseHistory = field(default_factory=PoseHistory)
    camera_delay: DelayKept = field(default_factory=DelayKept)


def driven(way: list[PlanarStep]) -> tuple[Kept, list[PlanarPose]]:
    kept, poses = Kept(), [PlanarPose()]
    for step in way:
        poses.append(poses[-1].after(step))
    for i, pose in enumerate(poses, 1):
        kept.poses.add(i * 100 * MS, pose)
        kept.frames.add(Frame(i, i * 100 * MS, i * 100 * MS, SIZE, b"jpeg"))
    return kept, poses


def sighting(frame_id: int, pose: PlanarPose) -> Sighting:
    return Sighting(frame_id, frame_id * 100 * MS, Pixel(320.0, 240.0), 0.5, 1.0, pose)


@given(steps)
def test_later_pictures_are_placed_where_the_wheels_had_the_base_in_order_and_apart(
    way: list[PlanarStep],
) -> None:
    kept, poses = driven(way)
    found = later_pictures(kept, sighting(1, poses[0]))
    for each in found:
        assert is_apart(each.world_from_base, poses[0], 0.02, 0.09)
        off = each.world_from_base.between(poses[each.frame_id - 1])
        assert abs(off.x) + abs(off.y) + abs(off.heading) < 1e-9
    ids = [each.frame_id for each in found]
    assert ids == sorted(set(ids))
    if is_apart(poses[-1], poses[0], 0.03, 0.1):
        assert ids[-1] == len(poses)


def test_a_robot_that_stands_still_takes_no_later_pictures() -> None:
    kept, poses = driven([PlanarStep(0.0, 0.0)] * 5)
    assert later_pictures(kept, sighting(1, poses[0])) == []
