"""The part of a Robot that every driver shares: its description, and its health, told when it changes."""

from collections.abc import Callable

from tapreach.robot.config import RobotDescription
from tapreach.robot.interface import Listeners, Unsubscribe
from tapreach.robot.messages import Health, LinkStatus


class DriverRobot:
    """To be derived from; `_set_health` is the one way in which health changes. reason: of the beginning."""

    def __init__(self, description: RobotDescription, reason: str = "") -> None:
        self.description = description
        self._health = Health(LinkStatus.STARTING, reason)
        self._health_listeners = Listeners()

    @property
    def health(self) -> Health:
        """See Robot."""
        return self._health

    def subscribe_health(self, listener: Callable[[Health], None]) -> Unsubscribe:
        """See Robot."""
        return self._health_listeners.subscribe(listener)

    def _set_health(self, health: Health) -> None:
        if health != self._health:
            self._health = health
            self._health_listeners.tell(health)
