"""A board of the framed protocol, written with the codec: wheels obey at once, by the firmware's rules."""

import math
from collections.abc import Callable

from tapreach.drivers.arduino.frame_reader import FrameReader, encode
from tapreach.drivers.arduino.wire import (
    DEADMAN_MS,
    EARLIEST_MS,
    OLDEST_MS,
    SESSION_SILENCE_MS,
    TELEMETRY_HZ,
    VERSION,
    Ack,
    Board,
    Clear,
    Drive,
    Fault,
    Feature,
    Hello,
    Keep,
    Message,
    Move,
    Moved,
    MoveResult,
    Ping,
    Pong,
    ResetCause,
    Result,
    ServoLimits,
    Servos,
    State,
    Stop,
    Telemetry,
    Welcome,
)
from tapreach.robot.clock import SECOND, Clock

WRAP = 2**32
TELEMETRY_NS = SECOND // TELEMETRY_HZ


class PeerBoard:
    """Give `take` what comes; `step` now and then; replies leave through `write`."""

    def __init__(self, clock: Clock, boot_us: int = 4_293_000_000, first_tick: int = 2**31 - 60) -> None:
        self._clock = clock
        self._first_tick = first_tick
        self.write: Callable[[bytes], None] = lambda data: None
        self.version, self.boot_id = VERSION, 7
        self.refused: dict[type, Result] = {}
        self.is_mute = self.is_deaf = False
        self.asked: list[Message] = []
        self._boot(boot_us, ResetCause.POWER_ON)

    def _boot(self, boot_us: int, cause: ResetCause) -> None:
        self._born_ns = self._stepped_ns = self._clock.now_ns() - boot_us * 1000
        self._stepped_ns = self._heard_ns = self._drive_ns = self._told_ns = self._clock.now_ns()
        self._cause = cause
        self._reader, self._seq = FrameReader(), 0
        self.has_session = False
        self.state, self.faults = State.NEEDS_ZERO, Fault(0)
        self.ticks = [float(self._first_tick)] * 2
        self.speeds = [0.0, 0.0]
        self._move: tuple[Move, float] | None = None
        self.pulses, self.goals = [0.0] * 4, [0.0] * 4
        self._servo_speeds = [0.0] * 4
        self.limits: dict[int, ServoLimits] = {}

    def reboot(self, cause: ResetCause = ResetCause.BROWN_OUT) -> None:
        """Start anew, as after a reset."""
        self.boot_id += 1
        self._first_tick = 0
        self._boot(1000, cause)

    @property
    def now_us(self) -> int:
        return (self._clock.now_ns() - self._born_ns) // 1000 % WRAP

    def take(self, data: bytes) -> None:
        for received in self._reader.feed(b"" if self.is_deaf else data):
            self.asked.append(received.message)
            self._heard_ns = self._clock.now_ns()
            self._answer(received.seq, received.message)

    def _answer(self, seq: int, message: Message) -> None:
        if isinstance(message, Hello):
            self.has_session = True
            features = Feature.QUADRATURE | Feature.SERVOS
            self.say(Welcome(self.version, Board.UNO, 1, features, 150, 50, self._cause, self.boot_id))
        elif isinstance(message, Ping):
            self.say(Pong(message.token, self.now_us))
        elif not self.has_session:
            self.say(Ack(seq, Result.NO_SESSION))
        else:
            self.say(Ack(seq, self.refused.get(type(message)) or self._obey(message)))

    def say(self, message: Message) -> None:
        self._seq += 1
        if not self.is_mute:
            self.write(encode(message, self._seq))

    def _obey(self, message: Message) -> Result:
        if isinstance(message, Drive | Move | Keep):
            return self._obey_wheels(message)
        if isinstance(message, Stop):
            self._off(State.NEEDS_ZERO, MoveResult.STOPPED)
        elif isinstance(message, Servos):
            self._send_servos(message)
        elif isinstance(message, ServoLimits):
            self.limits[message.index] = message
        elif isinstance(message, Clear):
            self.faults &= ~message.faults
            if not self.faults and self.state is State.FAULTED:
                self.state = State.NEEDS_ZERO
        return Result.OK

    def _obey_wheels(self, message: Drive | Move | Keep) -> Result:
        age_us = (self.now_us - message.at_ms * 1000 + WRAP // 2) % WRAP - WRAP // 2
        if not -EARLIEST_MS * 1000 <= age_us <= OLDEST_MS * 1000:
            return Result.TOO_OLD
        if self.faults:
            return Result.FAULTED
        if isinstance(message, Drive):
            is_zero = message.left == message.right == 0
            if self.state in (State.NEEDS_ZERO, State.TRIPPED) and not is_zero:
                return Result.NEEDS_ZERO
            if self._move is not None and not is_zero:
                return Result.BUSY
            self._off(State.READY if is_zero else State.DRIVING, MoveResult.STOPPED)
            self.speeds = [float(message.left), float(message.right)]
        elif isinstance(message, Move):
            if self.state is not State.READY:
                return Result.BUSY if self._move else Result.NEEDS_ZERO
            self.state, self._move = State.MOVING, (message, 0.0)
        self._drive_ns = self._clock.now_ns()
        return Result.OK

    def _send_servos(self, message: Servos) -> None:
        for index, (pulse, speed) in enumerate(zip(message.pulse_us, message.speed_us_per_s, strict=True)):
            limits = self.limits[index]
            if pulse and not self.pulses[index]:
                self.pulses[index] = float(limits.rest_us)
            if pulse:
                self.goals[index] = float(max(limits.low_us, min(limits.high_us, pulse)))
            self._servo_speeds[index] = speed or self._servo_speeds[index]

    def latch(self, fault: Fault) -> None:
        self.faults |= fault
        self._off(State.FAULTED, MoveResult.FAULTED)

    def _off(self, state: State, result: MoveResult) -> None:
        self.state, self.speeds = state, [0.0, 0.0]
        if self._move is not None:
            (move, done), self._move = self._move, None
            self.say(Moved(move.id, result, round(move.left * done), round(move.right * done)))

    def step(self) -> None:
        now_ns = self._clock.now_ns()
        elapsed = (now_ns - self._stepped_ns) / SECOND
        self._stepped_ns = now_ns
        is_turning = self.state in (State.DRIVING, State.MOVING, State.READY)
        if is_turning and now_ns - self._drive_ns > DEADMAN_MS * 1_000_000:
            self._off(State.TRIPPED, MoveResult.TRIPPED)
        self._turn_wheels(elapsed)
        for index, goal in enumerate(self.goals):
            way, most = goal - self.pulses[index], self._servo_speeds[index] * elapsed
            self.pulses[index] += max(-most, min(most, way))
        if now_ns - self._heard_ns > SESSION_SILENCE_MS * 1_000_000:
            self.has_session = False
        if self.has_session and now_ns - self._told_ns >= TELEMETRY_NS:
            self._told_ns = now_ns
            self.say(self.telemetry())

    def _turn_wheels(self, elapsed: float) -> None:
        ways = [speed * elapsed for speed in self.speeds]
        if self._move is not None:
            move, done = self._move
            longest = max(abs(move.left), abs(move.right))
            share = min(1.0 - done, move.speed * elapsed / longest)
            ways = [move.left * share, move.right * share]
            self._move = (move, done + share)
        self.ticks = [ticks + way for ticks, way in zip(self.ticks, ways, strict=True)]
        if self._move is not None and self._move[1] >= 1.0 - 1e-12:
            self._off(State.READY, MoveResult.DONE)

    def telemetry(self) -> Telemetry:
        left, right = ((math.floor(t) + 2**31) % WRAP - 2**31 for t in self.ticks)
        a, b, c, d = (round(pulse) for pulse in self.pulses)
        move_id, to_go = (self._move[0].id, round(1000 * (1 - self._move[1]))) if self._move else (0, 0)
        return Telemetry(
            self.now_us, left, right, round(self.speeds[0]), round(self.speeds[1]), (a, b, c, d), 7400,
            self.faults, self.state, move_id, to_go,
        )  # fmt: skip
