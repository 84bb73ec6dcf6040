"""The newest picture, whole and with the id by which a pixel of it can be named."""

import asyncio
import http.client
from dataclasses import dataclass

from tapreach.client.address import ServerAddress
from tapreach.errors import FrameError, LinkLost, SetupError
from tapreach.robot.clock import MS, SECOND, Clock
from tapreach.vision.image_io import BrokenPicture, Color, decode_color

TIMEOUT_S = 5.0
FIRST_PICTURE_NS = 5 * SECOND
_AGAIN_NS = 50 * MS
_NO_PICTURE_YET = 503


@dataclass(frozen=True, slots=True)
class Snapshot:
    """A picture as the camera made it. captured_ns: on the server's monotonic clock."""

    frame_id: int
    captured_ns: int
    jpeg: bytes

    def picture(self) -> Color:
        """Return it decoded, (height, width, 3), blue, green, red. Raises FrameError for a broken one."""
        picture = decode_color(self.jpeg)
        if isinstance(picture, BrokenPicture):
            raise FrameError(f"frame {self.frame_id} is broken: {picture.reason}")
        return picture


async def newest_snapshot(address: ServerAddress, clock: Clock) -> Snapshot:
    """Ask for the newest picture, waiting for the first one. Raises LinkLost, SetupError."""
    give_up_ns = clock.now_ns() + FIRST_PICTURE_NS
    while True:
        snapshot = await asyncio.to_thread(_asked, address)
        if snapshot is not None:
            return snapshot
        if clock.now_ns() >= give_up_ns:
            raise LinkLost("the camera has sent no picture for 5 s")
        await clock.sleep_until(clock.now_ns() + _AGAIN_NS)


def _asked(address: ServerAddress) -> Snapshot | None:
    connection = http.client.HTTPConnection(address.host, address.port, timeout=TIMEOUT_S)
    try:
        connection.request("GET", address.path("/snapshot.jpg"))
        answer = connection.getresponse()
        body = answer.read()
    except (OSError, http.client.HTTPException) as error:
        raise LinkLost(f"no picture from {address.page}: {error}") from error
    finally:
        connection.close()
    if answer.status == _NO_PICTURE_YET:
        return None
    if answer.status != http.client.OK:
        said = body[:200].decode(errors="replace").strip()
        raise SetupError(f"no picture from {address.page}: {answer.status}, {said}")
    return Snapshot(int(answer.headers["X-Frame-Id"]), int(answer.headers["X-Captured-Ns"]), body)
