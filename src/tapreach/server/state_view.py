"""The `state` message: what every page shows all the time."""

from typing import TYPE_CHECKING

from tapreach.robot.interface import Base
from tapreach.robot.own_moves import MovesByItself
from tapreach.server.message_parts import LeaseView
from tapreach.server.messages import State
from tapreach.server.views import arm_view, odometry_view, twist_view

if TYPE_CHECKING:
    from tapreach.server.station import Station


class StateView:
    """Reads the station's parts."""

    def __init__(self, station: "Station") -> None:
        self._station = station

    def now(self) -> State:
        """Return the present state."""
        station = self._station
        senses, health = station.loop.senses, station.robot.health
        return State(
            server_ns=station.clock.now_ns(),
            sent=twist_view(station.loop.sent.twist),
            limited_by=station.loop.sent.limited_by,
            own_move=_done_of_own_move(station.robot.base),
            odometry=odometry_view(senses.odometry) if senses.odometry else None,
            arm=arm_view(senses.arm) if senses.arm else None,
            lease=self._lease(),
            emergency_stop=station.emergency_stop.text,
            health=health.status.value,
            health_reason=health.reason,
            viewers=station.feed.viewers,
            overruns=station.loop.overruns,
        )

    def _lease(self) -> LeaseView:
        status, guests = self._station.lease.status, self._station.guests
        return LeaseView(
            holder_id=status.holder_id,
            holder_name=guests.name_of(status.holder_id),
            is_idle=status.is_idle,
            asked_by_id=status.asked_by_id,
            asked_by_name=guests.name_of(status.asked_by_id),
        )


def _done_of_own_move(base: Base) -> float | None:
    move = base.own_move if isinstance(base, MovesByItself) else None
    return None if move is None else move.fraction
