"""A robot behind a running `tapreach run`, for programs: look, locate, fetch, stop."""

import asyncio
import contextlib
from collections.abc import AsyncIterator
from typing import Literal

from tapreach.client.address import LOCAL, ServerAddress
from tapreach.client.control_link import ControlLink, RequestRefused, open_link
from tapreach.client.fetching import Fetching
from tapreach.client.news import PROTOCOL_VERSION, FetchNews, Greeting, Verb
from tapreach.client.presence import Presence
from tapreach.client.snapshot import Snapshot, newest_snapshot
from tapreach.client.standing import Standing
from tapreach.client.task_watch import TaskResult, watching
from tapreach.errors import LinkLost, SetupError
from tapreach.geometry.pixel import ImageSize, Pixel, require_inside
from tapreach.geometry.pixel_box import PixelBox
from tapreach.robot.clock import Clock, MonotonicClock

Mode = Literal["plan", "confirm", "go"]
LEASE_S = 8.0
"""Who drives has 5 s to answer; silence is consent."""
FAREWELL_S = 2.0


class RemoteRobot:
    """One session that drives. Made by `connect`; every method may raise LinkLost and RequestRefused.

    Pixels (u, v) are those of the camera's full picture, (0, 0) in the middle of the top-left one.
    """

    def __init__(
        self, link: ControlLink, address: ServerAddress, greeting: Greeting, standing: Standing
    ) -> None:
        self.link = link
        """The session itself, for requests of docs/protocol.md that have no method here."""
        self._address = address
        self.presence = Presence(link)
        self.session_id = greeting.session_id
        self.name = greeting.robot
        self.picture_size = ImageSize(greeting.camera.width, greeting.camera.height)
        self._standing = standing

    @property
    def newest_fetch(self) -> FetchNews | None:
        """What was told of fetching last, also by an earlier session: a held thing shows its `verbs`."""
        return self._standing.fetch

    @property
    def has_lease(self) -> bool:
        """Whether this session drives."""
        return self._standing.is_driven_by(self.session_id)

    async def snapshot(self) -> Snapshot:
        """Return the newest picture with its frame id."""
        return await newest_snapshot(self._address, self.link.clock)

    async def locate(
        self, frame_id: int, u: float, v: float, *, box: PixelBox | None = None, accuracy: float | None = None
    ) -> TaskResult:
        """Find out where a thing is, by a short move. accuracy: one sigma of the range, relative to it.

        box: drawn around the thing on the same picture; its size is measured too. Raises InputError for a
        pixel that is not on the picture.
        """
        fields = self._tap(frame_id, u, v, box) | {"purpose": "locate", "accuracy": accuracy}
        async with watching(self.link) as watch:
            await self.link.ask("tap", on_answer=watch.begin, **fields)
            await self.link.until(lambda: watch.is_told)
            return watch.result(frame_id)

    async def fetch(
        self, frame_id: int, u: float, v: float, *, mode: Mode = "go", box: PixelBox | None = None
    ) -> Fetching:
        """Begin to fetch what is at that pixel of that frame; arguments as `locate`.

        mode: "plan" says whether and how, "confirm" then waits for `Fetching.confirm`, "go" does it.
        """
        return await Fetching(self.link).request("fetch", mode=mode, **self._tap(frame_id, u, v, box))

    async def fetch_target(self, target_id: int, *, mode: Mode = "go") -> Fetching:
        """Begin to fetch a target that has a position and is in the picture."""
        return await Fetching(self.link).request("fetch", mode=mode, target_id=target_id)

    async def resume_fetch(self) -> Fetching:
        """Go on with the fetch that was stopped."""
        return await Fetching(self.link).request("fetch_resume")

    async def follow_up(self, verb: Verb) -> TaskResult:
        """Do something with the thing that is held, and return when it is done."""
        async with watching(self.link) as watch:
            await self.link.ask("fetch_verb", on_answer=watch.begin, verb=verb)
            await self.link.until(lambda: watch.is_told)
            return watch.result()

    async def stop(self) -> None:
        """Zero speed now; a running task ends, the arm holds its pose."""
        await self.link.ask("stop", reason="button")

    async def emergency_stop(self) -> None:
        """Latch the emergency stop. Raises RequestRefused when the robot does not confirm it."""
        await self.link.ask("emergency_stop")

    async def emergency_reset(self) -> None:
        """Release the emergency stop; nothing moves by that."""
        await self.link.ask("emergency_reset")

    async def take_lease(self) -> None:
        """Ask to drive and wait for the answer of who does. Raises RequestRefused."""
        try:
            await self.link.ask("lease_request")
        except RequestRefused as refused:
            if not await self.link.is_so_within(lambda: self.has_lease, LEASE_S):
                driver = self._standing.driver
                raise RequestRefused(f"{driver} drives and has not handed over: {refused}") from refused

    async def farewell(self) -> None:
        """Stop, and give the lease back; quietly, as far as the link still carries it."""
        with contextlib.suppress(LinkLost, RequestRefused, TimeoutError):
            async with asyncio.timeout(FAREWELL_S):
                await self.stop()
                await self.link.ask("lease_release")

    def _tap(self, frame_id: int, u: float, v: float, box: PixelBox | None) -> dict[str, object]:
        require_inside(Pixel(u, v), self.picture_size)
        sides = None if box is None else (box.left, box.top, box.right, box.bottom)
        return {"frame_id": frame_id, "u": float(u), "v": float(v), "box": sides}


@contextlib.asynccontextmanager
async def connect(
    url: str = LOCAL, *, name: str = "script", is_attended: bool = True, clock: Clock | None = None
) -> AsyncIterator[RemoteRobot]:
    """Yield the robot served at `url`, with the lease; however the block ends, the robot then stands.

    url: as `tapreach run` printed it, with its token. name: shown to others as who drives. While the block
    runs the script counts as the operator who watches: when its event loop hangs, or the process dies, the
    robot stops within 200 ms. is_attended False leaves that to `RemoteRobot.presence`.
    Raises SetupError where no server answers, RequestRefused where somebody else drives, InputError.
    """
    address = ServerAddress.parse(url)
    async with open_link(address, clock or MonotonicClock()) as link:
        standing = Standing()
        link.subscribe(standing.hear)
        robot = RemoteRobot(link, address, await _greeted(link, name), standing)
        beating = asyncio.create_task(robot.presence.beat(), name="heartbeats")
        try:
            await robot.take_lease()
            async with robot.presence.attended() if is_attended else contextlib.nullcontext():
                yield robot
        finally:
            await robot.farewell()
            beating.cancel()
            await asyncio.gather(beating, return_exceptions=True)


async def _greeted(link: ControlLink, name: str) -> Greeting:
    greeting = Greeting.model_validate(await link.ask("hello", name=name))
    if greeting.protocol_version != PROTOCOL_VERSION:
        raise SetupError(
            f"the server speaks version {greeting.protocol_version} of the protocol, this client "
            f"{PROTOCOL_VERSION}: install the same tapreach on both sides"
        )
    return greeting
