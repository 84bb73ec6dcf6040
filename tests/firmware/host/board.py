"""The firmware's code above its registers, compiled for the host and driven frame by frame."""

import ctypes
import shutil
import subprocess
from functools import cache
from pathlib import Path
from tempfile import mkdtemp

from tapreach.drivers.arduino import wire
from tapreach.drivers.arduino.frame_reader import FrameReader, encode

HERE = Path(__file__).parent
FIRMWARE = HERE.parents[2] / "firmware" / "tapreach"
MS = 1000
_WORDS = (
    "-std=c++11",
    "-O1",
    "-g",
    "-Wall",
    "-Wextra",
    "-Werror",
    "-shared",
    "-fPIC",
    "-fsanitize=undefined",
)
_FLAGS = (*_WORDS, "-fno-sanitize-recover=undefined", "-static-libubsan")
_ANSWERS = {"angle": ctypes.c_double, "now": ctypes.c_uint64, "off_since": ctypes.c_uint64}
_ANSWERS |= {"pushes": ctypes.c_uint64, "bad_frames": ctypes.c_uint32, "take_output": ctypes.c_uint32}
HAS_COMPILER = shutil.which("g++") is not None


@cache
def library() -> ctypes.CDLL:
    """The compiled harness; undefined behaviour ends the process."""
    target = Path(mkdtemp(prefix="tapreach-firmware-")) / "harness.so"
    words = ["g++", *_FLAGS, f"-I{FIRMWARE}", str(HERE / "harness.cpp"), "-o", str(target)]
    subprocess.run(words, check=True, timeout=120)
    loaded = ctypes.CDLL(str(target))
    for name, answer in _ANSWERS.items():
        getattr(loaded, name).restype = answer
    loaded.boot.argtypes = [ctypes.c_uint64, ctypes.c_uint8]
    loaded.run.argtypes = loaded.skip.argtypes = [ctypes.c_uint64]
    loaded.set_angle.argtypes = [ctypes.c_int, ctypes.c_double]
    return loaded


class Board:
    """A board that has just booted. Times [µs] are its own and never those of the machine."""

    def __init__(self, at_us: int = 0, reset_cause: wire.ResetCause = wire.ResetCause.POWER_ON) -> None:
        self.lib = library()
        self.lib.boot(at_us, reset_cause)
        self._reader = FrameReader()
        self._seq = 0
        self._buffer = (ctypes.c_uint8 * 65536)()
        self.heard: list[wire.Message] = []

    @property
    def now_us(self) -> int:
        return self.lib.now()

    @property
    def now_ms(self) -> int:
        """What a host sends as at_ms."""
        return self.now_us // 1000 % 2**32

    @property
    def pwm(self) -> tuple[int, int]:
        return self.lib.pwm(0), self.lib.pwm(1)

    @property
    def angles(self) -> tuple[float, float]:
        return self.lib.angle(0), self.lib.angle(1)

    @property
    def pulses(self) -> list[int]:
        return [self.lib.pulse(index) for index in range(4)]

    def run(self, us: int) -> None:
        self.lib.run(us)
        self._listen()

    def run_kept(self, us: int) -> None:
        """Run with a Keep every 50 ms."""
        for _ in range(0, us, 50 * MS):
            self.tell(wire.Keep(self.now_ms))
            self.run(50 * MS)

    def feed(self, data: bytes) -> bytes:
        """Hand bytes to the firmware and return those that it sends at once."""
        self.lib.receive(data, len(data))
        return self._listen()

    def tell(self, message: wire.Message) -> wire.Message:
        """Send a message and return the answer to it."""
        self._seq += 1
        before = len(self.heard)
        self.feed(encode(message, self._seq))
        answers = [m for m in self.heard[before:] if not isinstance(m, wire.Moved)]
        assert len(answers) == 1, answers
        return answers[0]

    def result(self, message: wire.Message) -> wire.Result:
        answer = self.tell(message)
        assert isinstance(answer, wire.Ack)
        assert answer.of == self._seq % 256
        return answer.result

    def drive(self, left: int, right: int, age_ms: int = 0) -> wire.Result:
        return self.result(wire.Drive(left, right, (self.now_ms - age_ms) % 2**32))

    def make_ready(self) -> None:
        """Open a session and give the zero that makes the wheels ready."""
        assert isinstance(self.tell(wire.Hello(wire.VERSION)), wire.Welcome)
        assert self.drive(0, 0) is wire.Result.OK

    def telemetry(self) -> wire.Telemetry:
        """The next telemetry, after at most 30 ms."""
        before = len(self.heard)
        self.run(30 * MS)
        return next(m for m in self.heard[before:] if isinstance(m, wire.Telemetry))

    def all_heard(self, kind: type) -> list:
        return [message for message in self.heard if isinstance(message, kind)]

    def _listen(self) -> bytes:
        count = self.lib.take_output(self._buffer)
        data = bytes(self._buffer[:count])
        self.heard += [received.message for received in self._reader.feed(data)]
        return data
