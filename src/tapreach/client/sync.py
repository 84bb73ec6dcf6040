"""The robot for plain scripts: `connect` without async. A thread of its own keeps up the link.

The script counts as present only while it waits in a call: hanging in between, it cannot keep a robot moving.
"""

import contextlib
from collections.abc import Awaitable, Callable, Iterator
from typing import TypeVar

from anyio.from_thread import BlockingPortal, start_blocking_portal

from tapreach.client import remote_robot
from tapreach.client.address import LOCAL
from tapreach.client.control_link import RequestRefused
from tapreach.client.fetching import Fetching, FetchResult
from tapreach.client.news import FetchNews, Verb
from tapreach.client.remote_robot import Mode, RemoteRobot
from tapreach.client.snapshot import Snapshot
from tapreach.client.task_watch import TaskResult
from tapreach.geometry.pixel_box import PixelBox

T = TypeVar("T")
OnPhase = Callable[[FetchNews], object]
Agrees = Callable[[FetchNews], bool]


class SyncRobot:
    """As RemoteRobot, each call blocking until it is done; made by `connect`."""

    def __init__(self, portal: BlockingPortal, robot: RemoteRobot) -> None:
        self._portal = portal
        self._robot = robot
        self.name = robot.name
        self.picture_size = robot.picture_size

    @property
    def newest_fetch(self) -> FetchNews | None:
        """What was told of fetching last; a held thing shows its `verbs`."""
        return self._robot.newest_fetch

    def snapshot(self) -> Snapshot:
        """See RemoteRobot."""
        return self._call(self._robot.snapshot)

    def locate(
        self, frame_id: int, u: float, v: float, *, box: PixelBox | None = None, accuracy: float | None = None
    ) -> TaskResult:
        """See RemoteRobot."""
        with self._attended():
            return self._call(lambda: self._robot.locate(frame_id, u, v, box=box, accuracy=accuracy))

    def fetch(
        self,
        frame_id: int,
        u: float,
        v: float,
        *,
        mode: Mode = "go",
        box: PixelBox | None = None,
        on_phase: OnPhase = lambda _: None,
        agrees: Agrees = lambda _: False,
    ) -> FetchResult:
        """Fetch as RemoteRobot does, and return how it ended.

        on_phase: called with each phase as it comes. agrees: called in mode "confirm" with the plan; False
        stops. Both are called in the caller's thread; the script counts as present meanwhile.
        """
        with self._attended():
            fetching = self._call(lambda: self._robot.fetch(frame_id, u, v, mode=mode, box=box))
            return self._followed(fetching, on_phase, agrees)

    def fetch_target(
        self,
        target_id: int,
        *,
        mode: Mode = "go",
        on_phase: OnPhase = lambda _: None,
        agrees: Agrees = lambda _: False,
    ) -> FetchResult:
        """Fetch a target that has a position and is in the picture; see `fetch`."""
        with self._attended():
            fetching = self._call(lambda: self._robot.fetch_target(target_id, mode=mode))
            return self._followed(fetching, on_phase, agrees)

    def resume_fetch(
        self, *, on_phase: OnPhase = lambda _: None, agrees: Agrees = lambda _: False
    ) -> FetchResult:
        """Go on with the fetch that was stopped; see `fetch`."""
        with self._attended():
            return self._followed(self._call(self._robot.resume_fetch), on_phase, agrees)

    def follow_up(self, verb: Verb) -> TaskResult:
        """See RemoteRobot."""
        with self._attended():
            return self._call(lambda: self._robot.follow_up(verb))

    def stop(self) -> None:
        """See RemoteRobot."""
        self._call(self._robot.stop)

    def emergency_stop(self) -> None:
        """See RemoteRobot."""
        self._call(self._robot.emergency_stop)

    def emergency_reset(self) -> None:
        """See RemoteRobot."""
        self._call(self._robot.emergency_reset)

    def _followed(self, fetching: Fetching, on_phase: OnPhase, agrees: Agrees) -> FetchResult:
        while (phase := self._call(lambda: anext(fetching, None))) is not None:
            on_phase(phase)
            if phase.may_confirm:
                self._answer(fetching, agrees(phase))
        return self._call(fetching.result)

    def _answer(self, fetching: Fetching, is_agreed: bool) -> None:
        # Refused when it was stopped meanwhile: its result says by whom.
        with contextlib.suppress(RequestRefused):
            self._call(fetching.confirm if is_agreed else self._robot.stop)

    def _attended(self) -> contextlib.AbstractContextManager[None]:
        return self._portal.wrap_async_context_manager(self._robot.presence.attended())

    def _call(self, call: Callable[[], Awaitable[T]]) -> T:
        waiting = self._portal.start_task_soon(call)
        try:
            return waiting.result()
        except BaseException:
            waiting.cancel()
            raise


@contextlib.contextmanager
def connect(url: str = LOCAL, *, name: str = "script") -> Iterator[SyncRobot]:
    """Yield the robot served at `url`; see `remote_robot.connect`. Ctrl-C in the block stops the robot."""
    with start_blocking_portal() as portal:
        opening = remote_robot.connect(url, name=name, is_attended=False)
        with portal.wrap_async_context_manager(opening) as robot:
            yield SyncRobot(portal, robot)
