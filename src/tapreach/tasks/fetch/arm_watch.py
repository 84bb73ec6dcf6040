"""Where the arm was last sent, as it says itself."""

import asyncio

from tapreach.robot.interface import Arm
from tapreach.robot.messages import ArmPose, ArmState


class ArmWatch:
    """Listens to the arm from `start` to `end`."""

    def __init__(self, arm: Arm) -> None:
        self._arm = arm
        self._heard = asyncio.Event()
        self._state: ArmState | None = None
        self._unsubscribe = arm.subscribe(self._hear)

    async def target(self) -> ArmPose:
        """Return where the arm was last sent; waits for its first word."""
        await self._heard.wait()
        assert self._state is not None
        return self._state.target

    def end(self) -> None:
        """Listen no more."""
        self._unsubscribe()

    def _hear(self, state: ArmState) -> None:
        self._state = state
        self._heard.set()
