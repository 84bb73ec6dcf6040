"""Exposure, white balance and focus of a V4L2 camera: held where they are, and let go again."""

from dataclasses import dataclass

from tapreach.drivers.camera.v4l2_abi import (
    CONTROL_DISABLED,
    CONTROL_READ_ONLY,
    G_CTRL,
    QUERYCTRL,
    S_CTRL,
    Control,
    ControlDescription,
)
from tapreach.drivers.camera.v4l2_device import Device


@dataclass(frozen=True, slots=True)
class Automatic:
    """A control that switches an automatic, its value for "by hand", and what the automatic would set."""

    name: str
    control: int
    by_hand: int
    sets: int | None


FOCUS = Automatic("focus", 0x009A090C, 0, 0x009A090A)
VARYING = (
    Automatic("exposure", 0x009A0901, 1, 0x009A0902),
    Automatic("exposure by a slower rate", 0x009A0903, 0, None),
    Automatic("gain", 0x00980912, 0, 0x00980913),
    Automatic("white balance", 0x0098090C, 0, 0x0098091A),
)


class HeldControls:
    """Automatics that were switched to "by hand", each with the value that it had before."""

    def __init__(self, device: Device) -> None:
        self._device = device
        self._before: dict[int, int] = {}

    def hold(self, automatic: Automatic) -> bool:
        """Keep what the automatic has found; False where the camera has no such automatic or it is off."""
        before = self._read(automatic.control)
        if before is None or before == automatic.by_hand:
            return False
        found = None if automatic.sets is None else self._read(automatic.sets)
        if not self._write(automatic.control, automatic.by_hand):
            return False
        self._before.setdefault(automatic.control, before)
        # Some cameras go back to what was last set by hand.
        if automatic.sets is not None and found is not None:
            self._write(automatic.sets, found)
        return True

    def release(self) -> None:
        """Switch the automatics on again."""
        for control, value in self._before.items():
            self._write(control, value)
        self._before.clear()

    def _read(self, control: int) -> int | None:
        description, value = ControlDescription(id=control), Control(id=control)
        try:
            self._device.ioctl(QUERYCTRL, description)
            if description.flags & (CONTROL_DISABLED | CONTROL_READ_ONLY):
                return None
            self._device.ioctl(G_CTRL, value)
        except OSError:  # the camera does not have it
            return None
        return int(value.value)

    def _write(self, control: int, value: int) -> bool:
        try:
            self._device.ioctl(S_CTRL, Control(id=control, value=value))
        except OSError:  # a camera that refuses goes on as it was
            return False
        return True
