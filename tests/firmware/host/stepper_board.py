"""The firmware for steppers, compiled for the host: `pwm` is steps/s, `angles` are steps."""

import ctypes
import subprocess
from functools import cache
from pathlib import Path
from tempfile import mkdtemp

from tests.firmware.host import board as dc

from tapreach.drivers.arduino import wire
from tapreach.drivers.arduino.frame_reader import FrameReader


@cache
def library() -> ctypes.CDLL:
    """The compiled harness; undefined behaviour ends the process."""
    target = Path(mkdtemp(prefix="tapreach-firmware-")) / "stepper.so"
    source = dc.HERE / "stepper.cpp"
    words = ["g++", *dc._FLAGS, "-DTAPREACH_STEPPER", f"-I{dc.FIRMWARE}", str(source), "-o", str(target)]
    subprocess.run(words, check=True, timeout=120)
    loaded = ctypes.CDLL(str(target))
    for name in ("now", "off_since", "turns_without_notice"):
        getattr(loaded, name).restype = ctypes.c_uint64
    loaded.angle.restype, loaded.take_output.restype = ctypes.c_double, ctypes.c_uint32
    loaded.boot.argtypes, loaded.run.argtypes = [ctypes.c_uint64, ctypes.c_uint8], [ctypes.c_uint64]
    return loaded


class StepperBoard(dc.Board):
    """A board with step drivers that has just booted."""

    def __init__(self) -> None:
        self.lib = library()
        self.lib.boot(0, wire.ResetCause.POWER_ON)
        self._reader, self._seq = FrameReader(), 0
        self._buffer = (ctypes.c_uint8 * 65536)()
        self.heard: list[wire.Message] = []

    def largest_jump(self) -> int:
        """The largest change of a rate from one period to the next since it was last asked for [steps/s]."""
        return self.lib.take_largest_jump()
