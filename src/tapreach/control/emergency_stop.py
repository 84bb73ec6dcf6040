"""The latched stop: anyone sets it, the operator in charge resets it, nothing else does."""

from collections.abc import Callable

from tapreach.robot.clock import Clock


class EmergencyStop:
    """Remembers who pressed first and when. `on_change` is called when it is set and when it is reset."""

    def __init__(self, clock: Clock, on_change: Callable[[], None] = lambda: None) -> None:
        self._clock = clock
        self._on_change = on_change
        self._pressed_by = ""

    @property
    def text(self) -> str:
        """Who pressed it and when (UTC); '' when it is not set."""
        return self._pressed_by

    @property
    def is_set(self) -> bool:
        """True from the press until the reset."""
        return bool(self._pressed_by)

    def press(self, who: str) -> None:
        """Latch. A second press changes nothing."""
        if not self._pressed_by:
            self._pressed_by = f"pressed by {who} at {self._clock.wall_time():%H:%M:%S} UTC"
            self._on_change()

    def reset(self) -> None:
        """Unlatch."""
        if self._pressed_by:
            self._pressed_by = ""
            self._on_change()
