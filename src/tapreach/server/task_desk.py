"""The seam between sessions and tasks."""

from typing import TYPE_CHECKING

from tapreach.control.pilot import Pilot
from tapreach.robot.messages import Frame

if TYPE_CHECKING:
    from tapreach.server.station import Station


class TaskDesk:
    """Starts, shows and cancels tasks."""

    def __init__(self, station: "Station", pilot: Pilot) -> None:
        self._station = station
        self._pilot = pilot

    @property
    def is_running(self) -> bool:
        return False

    async def start(self) -> None:
        return None

    async def close(self) -> None:
        return None

    def cancel(self, reason: str) -> bool:
        return False

    def frame_arrived(self, frame: Frame) -> None:
        return None
