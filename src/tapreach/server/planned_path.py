"""The move that a task is about to make: told to every page, and drawn into every frame until it is over."""

import numpy as np

from tapreach.geometry.finite import FloatArray
from tapreach.robot.config import RobotDescription
from tapreach.server.hub import Hub
from tapreach.server.messages import MoveView
from tapreach.tasks.planned_move import PlannedMove, footprint, wheel_tracks

_KEY = "move"
NO_MOVE = MoveView(
    tracks_in_world=(), body_in_world=(), words="", expected_sd=None, expected_relative_sd=None
)


class PlannedPath:
    """Keeps the newest move; None between moves."""

    def __init__(self, hub: Hub, description: RobotDescription) -> None:
        self._hub = hub
        self._description = description
        self._is_shown = False
        self.lines_in_world: list[FloatArray] = []
        """On the floor (n, 3) each [m]: the way of the robot's left side, of its right side, and its body
        at the end; none between moves.
        """

    def show(self, move: PlannedMove | None) -> None:
        """Show a move, or that it is over."""
        if move is None:
            self._hide()
            return
        tracks = wheel_tracks(move, self._description)
        body = footprint(move, self._description)
        self._is_shown = True
        self.lines_in_world = [
            np.array([(pose.x, pose.y, 0.0) for pose in line]) for line in (*tracks, (*body, body[0]))
        ]
        self._hub.tell(
            _KEY,
            MoveView(
                tracks_in_world=tuple(tuple((pose.x, pose.y) for pose in track) for track in tracks),
                body_in_world=tuple((pose.x, pose.y) for pose in body),
                words=move.in_words,
                expected_sd=move.expected_sd,
                expected_relative_sd=move.expected_relative_sd,
            ),
        )

    def _hide(self) -> None:
        if self._is_shown:
            self._is_shown = False
            self.lines_in_world = []
            self._hub.tell(_KEY, NO_MOVE)
            self._hub.forget(_KEY)
