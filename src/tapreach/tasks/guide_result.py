"""What comes out of a guided procedure, as lines for a person and as a target for the page."""

from dataclasses import dataclass, replace
from math import degrees

from tapreach.estimation.point_estimate import PointEstimate
from tapreach.estimation.rotation_centre import ColumnShift, rotation_centre
from tapreach.estimation.two_tap import TwoTapEstimate, two_tap_from_pixels
from tapreach.geometry.camera import Camera
from tapreach.geometry.finite import FloatArray
from tapreach.geometry.planar_motion import PlanarPose, PlanarStep
from tapreach.robot.config import RobotDescription
from tapreach.tasks.estimating import estimate
from tapreach.tasks.floor_guess import guess_of
from tapreach.tasks.guide_progress import GuideProgress, is_turn_then_advance
from tapreach.tasks.guide_state import GuideKind
from tapreach.tasks.sighting import Sighting
from tapreach.tasks.target import Target, TargetSource
from tapreach.tasks.target_report import TargetReport
from tapreach.tasks.task import Tap, TaskContext

_MODELLED = "Modelled (lever, pitch, lens)"


@dataclass(frozen=True)
class GuideResult:
    """Lines to read, '' until there is an answer; and the target of the two-tap procedure."""

    text: str
    target: Target | None = None


async def result_of(
    context: TaskContext, kind: GuideKind, progress: GuideProgress, target_id: int
) -> GuideResult:
    """Return what the taps so far amount to."""
    if not progress.is_complete:
        return GuideResult("")
    if kind is GuideKind.ROTATION_CENTRE:
        return GuideResult(rotation_centre_text(progress, context.description))
    first, second = progress.taps["first"], moved_second(progress)
    modelled = await context.compute.call(estimate, [first, second], context.description, True)
    tap = Tap(second.frame_id, second.pixel.u, second.pixel.v)
    report = TargetReport(target_id, TargetSource.TWO_TAP, tap, context.description)
    target = report.target([first, second], modelled, is_following=False)
    text = "\n".join([*paper_lines(progress, context.description), *modelled_lines(modelled, target)])
    return GuideResult(text, target)


def moved_second(progress: GuideProgress) -> Sighting:
    """Return the second tap, its pose by the typed values where there are any, by odometry where not."""
    first, second = progress.taps["first"], progress.taps["second"]
    if not progress.typed:
        return second
    step = PlanarStep(progress.theta(None) or 0.0, progress.distance(None) or 0.0)
    return replace(second, world_from_base=first.world_from_base.after(step))


def paper_lines(progress: GuideProgress, description: RobotDescription) -> list[str]:
    """Return the paper's answer in both frames with its height check, or why there is none."""
    driven = progress.driven(None)
    if not progress.typed and driven is not None and not is_turn_then_advance(driven):
        return [_not_the_papers_way(driven)]
    step = PlanarStep(progress.theta(None) or 0.0, progress.distance(None) or 0.0)
    first, second = progress.taps["first"], progress.taps["second"]
    found = two_tap_from_pixels(description.camera.model(), first.pixel, second.pixel, step)
    return _paper_answer(found)


def _not_the_papers_way(driven: PlanarPose) -> str:
    return (
        f"The paper's formula does not apply: the way was not a turn on the spot and then a straight advance "
        f"(it ends {100.0 * driven.x:.0f} cm ahead, {100.0 * driven.y:.0f} cm left, turned "
        f"{degrees(driven.heading):.0f}°). The robot's own odometry is used instead."
    )


def _paper_answer(found: TwoTapEstimate) -> list[str]:
    position = found.position
    if position is None:
        return [f"Paper: no answer; {found.reason}."]
    angles = f"beta {degrees(found.beta):.2f}°, phi {degrees(found.phi):.2f}°"
    return [
        f"Paper: OQ1 = {position.distance:.3f} m; {angles}.",
        f"From O (7): {_xyz(position.in_first)}.",
        f"From O_NEW (10): {_xyz(position.in_second)}.",
        f"Height check (11): the two heights differ by {100.0 * abs(position.height_difference):.1f} cm.",
    ]


def modelled_lines(modelled: PointEstimate, target: Target) -> list[str]:
    """Return the answer with lever, pitch and lens modelled, and in what it differs from the paper's."""
    note = (
        "The paper takes the camera to look level and to stand on the rotation axis; the modelled answer "
        "uses where it really is, so the two may differ."
    )
    if modelled.range is None or target.range is None or target.range_interval is None:
        return [f"{_MODELLED}: no position; {modelled.reason}. {modelled.advice}".rstrip(), note]
    low, high = target.range_interval
    interval = f"(95 %: {low:.2f} to {high:.2f} m)"
    return [f"{_MODELLED}: {target.range:.3f} m from the robot at the second tap {interval}.", note]


def rotation_centre_text(progress: GuideProgress, description: RobotDescription) -> str:
    """Return how far the camera lies off the rotation axis by the near and the far point, or why
    nobody can tell.
    """
    shifts = []
    for key in ("near", "far"):
        shift = _shift(progress, key, description)
        if shift is None:
            return f"No answer: the {key} point must be where a thing meets the floor, to tell its distance."
        shifts.append(shift)
    if shifts[0].depth >= shifts[1].depth:
        return "No answer: the near point lies farther away than the far one; tap the near one first."
    found = rotation_centre(_level_camera(description), shifts[0], shifts[1])
    if found is None:
        return "No answer: the points are too alike in distance, or the robot did not turn."
    lever, sigma = 100.0 * found.lever, 100.0 * found.lever_sigma
    verdict = "on the rotation axis as far as this can tell" if found.is_on_axis else "off the rotation axis"
    expected = 100.0 * description.camera.mount.forward
    return (
        f"The camera is {lever:.1f} ± {sigma:.1f} cm ahead of the rotation axis: {verdict}.\n"
        f"The robot file says {expected:.1f} cm. Turned {degrees(found.turn):.1f}° by the far point."
    )


def _shift(progress: GuideProgress, key: str, description: RobotDescription) -> ColumnShift | None:
    """Return the columns of one point before and after the turn; its depth by where it is on the floor."""
    before, after = progress.taps[key], progress.taps[f"{key}_again"]
    guess = guess_of(before, description)
    if guess.point_in_base is None or guess.point_cov_in_base is None:
        return None
    depth = float(guess.point_in_base[0]) - description.camera.mount.forward
    depth_sigma = float(guess.point_cov_in_base[0, 0]) ** 0.5
    columns = [_level_column(sighting, description) for sighting in (before, after)]
    return ColumnShift(columns[0], columns[1], max(depth, 0.01), depth_sigma)


def _level_camera(description: RobotDescription) -> Camera:
    """Return the robot's camera without distortion; what looks through it is taken to look level."""
    camera = description.camera.model()
    return Camera(camera.size, camera.fx, camera.fy, camera.cx, camera.cy)


def _level_column(sighting: Sighting, description: RobotDescription) -> float:
    """Return the column [px] at which a camera that looks level and straight ahead would see the place."""
    (direction,) = description.camera.model().unproject([sighting.pixel.to_array()])
    ahead, left, _ = description.camera.mount.base_from_camera().rotation.apply(direction)
    level = _level_camera(description)
    return level.cx - level.fx * float(left / ahead)


def _xyz(point: FloatArray) -> str:
    x, y, z = map(float, point)
    return f"X {100.0 * x:.1f}, Y {100.0 * y:.1f}, Z {100.0 * z:.1f} cm"
