"""The other end of the line, in lock step: frames with clock alignment, as the product sends them."""

from collections.abc import Callable
from typing import TypeVar

from tests.firmware.sim.rover import Rover

from tapreach.drivers.arduino import wire
from tapreach.drivers.arduino.frame_reader import FrameReader, Received, encode

M = TypeVar("M")
CHARACTER_US = 1e7 / wire.BAUD
ANSWER_US = 60_000.0


class NoAnswer(AssertionError):
    """The firmware did not say what was awaited."""


class Host:
    """Sends and hears frames. Simulated time passes only while it waits."""

    def __init__(self, rover: Rover) -> None:
        self.rover = rover
        self.reader = FrameReader()
        self.heard: list[Received] = []
        self.seq = 0
        self.offset_us = 0.0
        """Of the firmware's clock before simulated time."""

    def send(self, message: wire.Message) -> int:
        self.seq = (self.seq + 1) & 0xFF
        self.rover.avr.send(encode(message, self.seq))
        return self.seq

    def run(self, us: float) -> list[Received]:
        """Let time pass; return what was heard meanwhile."""
        self.rover.run(us)
        return self._listen()

    def _listen(self) -> list[Received]:
        new = self.reader.feed(self.rover.avr.receive())
        self.heard += new
        return new

    def await_message(
        self, kind: type[M], wanted: Callable[[M], bool] = lambda _: True, us: float = ANSWER_US
    ) -> M:
        """Run until a message of this kind comes. Raises NoAnswer naming what came instead."""
        end_us, others = self.rover.now_us + us, []
        while self.rover.now_us < end_us:
            self.rover.run_to(end_us, until_frame=True)
            for received in self._listen():
                if isinstance(received.message, kind) and wanted(received.message):
                    return received.message
                others.append(received.message)
        raise NoAnswer(f"no {kind.__name__} in {us / 1000:.0f} ms; heard {others[-5:]}")

    def ask(self, message: wire.Message) -> wire.Result:
        """Send a command and return the result in its Ack."""
        seq = self.send(message)
        return self.await_message(wire.Ack, lambda ack: ack.of == seq).result

    def open(self) -> wire.Welcome:
        """Say hello and align the clocks."""
        self.send(wire.Hello(wire.VERSION))
        welcome = self.await_message(wire.Welcome)
        self.align()
        return welcome

    def align(self, times: int = 5) -> None:
        """Take the offset of the ping with the shortest round trip."""
        self.offset_us = min(self._ping(token) for token in range(times))[1]

    def _ping(self, token: int) -> tuple[float, float]:
        sent_us = self.rover.now_us
        self.send(wire.Ping(token))
        pong = self.await_message(wire.Pong, lambda pong: pong.token == token)
        round_trip_us = self.rover.now_us - sent_us
        return round_trip_us, pong.at_us - (sent_us + round_trip_us / 2)

    def round_trip_us(self) -> float:
        """Return the time from a ping's first bit to a pong's last."""
        sent_us = self.rover.now_us
        self.send(wire.Ping(1))
        self.await_message(wire.Pong)
        return self.rover.now_us + CHARACTER_US - sent_us

    @property
    def at_ms(self) -> int:
        """The firmware's clock now, as this host believes it."""
        return int((self.rover.now_us + self.offset_us) // 1000) & 0xFFFFFFFF

    def drive(self, left: int, right: int) -> wire.Result:
        """Ask for wheel speeds [ticks/s]."""
        return self.ask(wire.Drive(left, right, self.at_ms))

    def drive_for(self, left: int, right: int, us: float, every_us: float = 50_000.0) -> None:
        """Drive as a host does, a message every 50 ms; assert that each is taken."""
        end_us = self.rover.now_us + us
        while self.rover.now_us < end_us:
            next_us = min(end_us, self.rover.now_us + every_us)
            result = self.drive(left, right)
            assert result is wire.Result.OK, result
            self.run(max(0.0, next_us - self.rover.now_us))

    def move(
        self, left: int, right: int, speed: int = 800, acceleration: int = 1500, move_id: int = 1
    ) -> wire.Moved:
        """Make a relative move to its end, keeping on. Raises NoAnswer when it never ends."""
        result = self.ask(wire.Move(move_id, left, right, speed, acceleration, self.at_ms))
        assert result is wire.Result.OK, result
        for _ in range(400):
            self.send(wire.Keep(self.at_ms))
            for received in self.run(50_000.0):
                if isinstance(received.message, wire.Moved) and received.message.id == move_id:
                    return received.message
        raise NoAnswer(f"the move {left}, {right} did not end")

    def telemetry(self) -> wire.Telemetry:
        """Return the next telemetry."""
        return self.await_message(wire.Telemetry)
