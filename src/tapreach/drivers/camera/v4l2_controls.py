"""Exposure, white balance and focus of a V4L2 camera: held where they are, and let go again."""

from collections.abc import Iterable
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


def switch_on(device: Device, automatics: Iterable[Automatic]) -> None:
    """Switch on those that the camera has on when plugged in; a program that was killed left them off."""
    for automatic in automatics:
        usual, value = _usual(device, automatic.control), _read(device, automatic.control)
        if value == automatic.by_hand and usual is not None and usual != value:
            _write(device, automatic.control, usual)


class HeldControls:
    """Automatics that were switched to "by hand", each with the value that it had before."""

    def __init__(self, device: Device) -> None:
        self._device = device
        self._before: dict[int, int] = {}

    def hold(self, automatic: Automatic) -> bool:
        """Keep what the automatic has found; False where the camera has no such automatic or it is off."""
        before = _read(self._device, automatic.control)
        if before is None or before == automatic.by_hand:
            return False
        found = None if automatic.sets is None else _read(self._device, automatic.sets)
        if not _write(self._device, automatic.control, automatic.by_hand):
            return False
        self._before.setdefault(automatic.control, before)
        # Some cameras go back to what was last set by hand.
        if automatic.sets is not None and found is not None:
            _write(self._device, automatic.sets, found)
        return True

    def release(self) -> None:
        """Switch the automatics on again."""
        for control, value in self._before.items():
            _write(self._device, control, value)
        self._before.clear()


def _usual(device: Device, control: int) -> int | None:
    """Return the value that the driver gives a control at first; None where there is no such control."""
    description = ControlDescription(id=control)
    try:
        device.ioctl(QUERYCTRL, description)
    except OSError:
        return None
    return (
        None if description.flags & (CONTROL_DISABLED | CONTROL_READ_ONLY) else int(description.default_value)
    )


def _read(device: Device, control: int) -> int | None:
    value = Control(id=control)
    if _usual(device, control) is None:
        return None
    try:
        device.ioctl(G_CTRL, value)
    except OSError:
        return None
    return int(value.value)


def _write(device: Device, control: int, value: int) -> bool:
    try:
        device.ioctl(S_CTRL, Control(id=control, value=value))
    except OSError:  # a camera that refuses goes on as it was
        return False
    return True
