"""What the phases of one fetch share: the robot's context, and what is known by now."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from tapreach.errors import TapreachError
from tapreach.estimation.footprint import SeenWidth
from tapreach.geometry.finite import FloatArray
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.tasks.estimating import LocatedPoint
from tapreach.tasks.fetch.arm_watch import ArmWatch
from tapreach.tasks.fetch.arm_workspace import ArmWorkspace
from tapreach.tasks.fetch.claw_room import Claw
from tapreach.tasks.fetch.kept_size import SizeDoubt, with_earlier
from tapreach.tasks.fetch.memory import FetchMemory
from tapreach.tasks.fetch.obstacle import Obstacle
from tapreach.tasks.fetch.reach_preview import ReachPreview
from tapreach.tasks.fetch.states import Outcome
from tapreach.tasks.fetch.surroundings import SeenAround
from tapreach.tasks.fetch.thing import NoSize, Thing, ThingSize
from tapreach.tasks.fetch.ways import Ways
from tapreach.tasks.locating import Locating
from tapreach.tasks.present_base import PresentPoint, at_present
from tapreach.tasks.task import TaskContext


@dataclass(frozen=True)
class Ended:
    """How a phase ended, and the reason in words for people."""

    outcome: Outcome
    why: str


class NotKnown(TapreachError):
    """Something is asked of a thing that has no position yet."""


@dataclass
class FetchRun:
    """One fetch on its way. Everything in the world of the present odometry.

    size: as last measured, its axis given by its offset (3,) [m] from the tapped place. earlier_size: as the
    looks before this one told it. size_doubt: of what was measured against it. seen: all widths, believed or
    not.
    """

    context: TaskContext
    memory: FetchMemory
    others: Sequence[Obstacle]
    arm_watch: ArmWatch
    ways: Ways = field(default_factory=Ways)
    locating: Locating | None = None
    size: ThingSize | NoSize = field(default_factory=lambda: NoSize("it has not been measured yet"))
    axis_offset: FloatArray | None = None
    earlier_size: ThingSize | None = None
    size_doubt: SizeDoubt = field(default_factory=SizeDoubt)
    seen: tuple[SeenWidth, ...] = ()
    preview: ReachPreview | None = None
    around: SeenAround = field(default_factory=SeenAround)

    def __post_init__(self) -> None:
        self.recall_size()

    def recall_size(self) -> None:
        """Go on with the size that the looks so far have told, if any."""
        known = self.memory.known
        if known is not None and known.size is not None:
            self.size = self.earlier_size = known.size
            self.axis_offset, self.seen = known.axis_offset, known.size.seen

    def forget(self) -> None:
        """Know nothing of the thing any more: what is looked at now is another one."""
        self.remember(known=None)
        self.size, self.axis_offset, self.earlier_size = NoSize("it has not been measured yet"), None, None
        self.seen = ()

    @property
    def here(self) -> PlanarPose:
        """Where the base is by the wheels."""
        return self.context.poses.newest()[1]

    def thing(self) -> Thing:
        """Return the thing where it is now known to be; where it was known to be, while its views contradict
        each other. Raises NotKnown before it has a position.
        """
        point, covariance = self._place()
        size = self.size
        if isinstance(size, ThingSize) and self.axis_offset is not None:
            size = replace(size, axis_in_world=point + self.axis_offset, axis_cov_in_world=covariance)
        return Thing(point, covariance, size)

    def _place(self) -> tuple[FloatArray, FloatArray]:
        """Return where the tapped spot is in the world (3,) [m], with its covariance (3, 3) [m²]."""
        estimate = self.locating.estimate if self.locating is not None else None
        present = None if estimate is None else self._at_present(estimate)
        if present is not None:
            return present.point_in_world, present.cov_in_world
        if self.memory.known is None:
            raise NotKnown("the thing has no position yet: locate it first")
        place = self.memory.known.place.seen_from(self.here, self.context.description)
        return place.point_in_world, place.cov_in_world

    def _at_present(self, estimate: LocatedPoint) -> PresentPoint | None:
        assert self.locating is not None
        return at_present(estimate, self.here, self.context.description, self.locating.way_since_seen)

    def axis_in_world(self) -> FloatArray:
        """Return the thing's middle (3,) [m]. Raises NotKnown before it was measured."""
        size = self.thing().size
        if isinstance(size, NoSize):
            raise NotKnown(f"its size is not known: {size.reason}")
        return size.axis_in_world

    def in_base(self, point_in_world: FloatArray) -> FloatArray:
        """Return a point (3,) [m] in the frame of the present base."""
        return np.asarray(self.here.to_rigid().inv().apply(point_in_world))

    @property
    def arm(self) -> ArmWorkspace:
        """The arm; once it was looked at, in the frame in which the estimate places what the camera sees."""
        filed = ArmWorkspace.of(self.context.description)
        estimate = self.locating.estimate if self.locating is not None else None
        if self.memory.zero is None:
            return filed
        mount = self.context.description.camera.mount.base_from_camera()
        seen = self.memory.zero.seen_arm(mount if estimate is None else estimate.base_from_camera)
        return filed if seen is None else replace(filed, kinematics=seen)

    @property
    def claw(self) -> Claw:
        """The arm as a grasp sees it."""
        return Claw(self.arm)

    @property
    def filed_claw(self) -> Claw:
        """The arm of the robot file, by which it is judged what can be gripped at all."""
        return Claw(ArmWorkspace.of(self.context.description))

    def measured(self, size: ThingSize | NoSize, point_in_world: FloatArray) -> None:
        """Take a new size, measured with the tapped place at `point_in_world`; one that cannot be told does
        not replace one that is known, nor does one that differs much, until another from elsewhere agrees.
        """
        along = self._sight_along(size)
        if isinstance(size, ThingSize):
            self.seen = (*self.seen, size.look_along(along))
        believed = self.size_doubt.believed(size, self.size, self.here, along)
        if believed is not None:
            self.axis_offset = np.asarray(believed.axis_in_world - point_in_world)
            along = self._sight_along(believed)
            self.size = self.sized_along(with_earlier(believed, self.earlier_size, along))
        elif isinstance(self.size, NoSize) and isinstance(size, NoSize):
            self.size = size
        if isinstance(self.size, ThingSize):
            is_doubted = self.size_doubt.against is not None
            denied = self.size_doubt.denied
            self.size = replace(self.size, seen=self.seen, is_doubted=is_doubted, denied=denied)

    def believe_one_view(self) -> None:
        """Take the size that a single view has told, where none is known and no better one is to come."""
        alone = self.size.by_one_view if isinstance(self.size, NoSize) else None
        if alone is not None:
            self.axis_offset = np.asarray(alone.axis_in_world - self.thing().point_in_world)
            self.size = replace(self.sized_along(alone), seen=self.seen)

    def sized_along(self, size: ThingSize) -> ThingSize:
        """Return a size with the direction of the sight across which it was measured, for later looks."""
        return size.seen_from(self.here)

    def _sight_along(self, size: ThingSize | NoSize) -> float:
        if isinstance(size, NoSize):
            return self.here.heading
        return size.sight_from(self.here) if size.seen_along is None else size.seen_along

    def remember(self, **changes: object) -> None:
        """Change what a stopped fetch goes on from."""
        self.memory = replace(self.memory, **changes)  # type: ignore[arg-type]
