"""The targets on the page: newest wins by id; told to every page and drawn into every frame."""

from tapreach.errors import InputError
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.server.hub import Hub
from tapreach.server.markers import Mark
from tapreach.server.messages import TargetGone
from tapreach.server.views import target_view
from tapreach.tasks.target import Target


class Targets:
    """Keeps what tasks have found."""

    def __init__(self, hub: Hub) -> None:
        self._hub = hub
        self._targets: dict[int, Target] = {}
        self._marks: dict[int, Mark] = {}
        self._ids = 0

    def new_id(self) -> int:
        """Return an id that no target has had."""
        self._ids += 1
        return self._ids

    @property
    def marks(self) -> list[Mark]:
        """What is to be drawn into frames."""
        return list(self._marks.values())

    def known(self) -> list[Target]:
        """Return the targets that have a position."""
        return [each for each in self._targets.values() if each.point_in_world is not None]

    def get(self, target_id: int) -> Target:
        """Return a target that has a position. Raises InputError naming those that have."""
        for target in self.known():
            if target.target_id == target_id:
                return target
        ids = ", ".join(str(each.target_id) for each in self.known()) or "none"
        raise InputError(f"there is no target {target_id} with a position; there are: {ids}")

    def show(self, target: Target, world_from_base: PlanarPose) -> None:
        """Show or update a target."""
        self._targets[target.target_id] = target
        mark = Mark.of(target)
        if mark is None:
            self._marks.pop(target.target_id, None)
        else:
            self._marks[target.target_id] = mark
        self._tell(target, world_from_base)

    def base_moved(self, world_from_base: PlanarPose) -> None:
        """Tell anew where the targets are, seen from the robot."""
        for target in self._targets.values():
            if target.point_in_world is not None:
                self._tell(target, world_from_base)

    def clear(self, target_id: int) -> bool:
        """Forget a target; False when there is none of this id."""
        if self._targets.pop(target_id, None) is None:
            return False
        self._marks.pop(target_id, None)
        # Same key: whatever still waits to be sent about this target gives way to its end.
        self._hub.tell(_key(target_id), TargetGone(target_id=target_id))
        self._hub.forget(_key(target_id))
        return True

    def _tell(self, target: Target, world_from_base: PlanarPose) -> None:
        self._hub.tell(_key(target.target_id), target_view(target, world_from_base))


def _key(target_id: int) -> str:
    return f"target {target_id}"
