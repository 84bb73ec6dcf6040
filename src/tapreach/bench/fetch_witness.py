"""Watches one fetch: what the robot tells of it, and what is true meanwhile."""

from tapreach.bench.fetch_outcome import PhaseEntry
from tapreach.bench.fetch_truth import Standing
from tapreach.drivers.sim.inline import InlineSimRobot
from tapreach.drivers.sim.truth import ask_truth
from tapreach.robot.clock import SECOND, Clock
from tapreach.tasks.fetch.fetch_state import FetchState
from tapreach.tasks.fetch.states import Phase

_CLOSED = (Phase.VERIFY, Phase.LIFT)


class Witness:
    """`hear` takes what is told as it is told; `look` is to be called again and again.

    lifted_ns: when the thing was first truly held; None before.
    """

    def __init__(self, robot: InlineSimRobot, clock: Clock) -> None:
        self._robot, self._clock = robot, clock
        self._standing: Standing | None = None
        self._tapped_ns = 0
        self._is_held = False
        self.told: list[FetchState] = []
        self.phases: list[PhaseEntry] = []
        self.lifted_ns: int | None = None
        self.is_denied = False

    def begin(self, standing: Standing) -> None:
        """The thing is tapped now."""
        self._standing, self._tapped_ns = standing, self._clock.now_ns()

    def hear(self, state: FetchState | None) -> None:
        """Take what the robot tells of its fetching."""
        if state is None:
            return
        before = self.phase
        self.told.append(state)
        self.phases.append(PhaseEntry(self.seconds, state.phase.value, state.why))
        is_given_up = before in _CLOSED and state.phase in (Phase.BACK_OFF, Phase.FAILED)
        self.is_denied = self.is_denied or (is_given_up and self._is_held)

    async def look(self) -> None:
        """Note whether the thing is truly held now."""
        if self._standing is None:
            return
        self._is_held = self._standing.is_held(await ask_truth(self._robot))
        if self._is_held and self.lifted_ns is None:
            self.lifted_ns = self._clock.now_ns()

    @property
    def phase(self) -> Phase | None:
        """The last that was told."""
        return self.told[-1].phase if self.told else None

    @property
    def seconds(self) -> float:
        """Since the tap."""
        return (self._clock.now_ns() - self._tapped_ns) / SECOND

    @property
    def lifted_after(self) -> float | None:
        """Seconds from the tap until the thing was first truly held; None when it never was."""
        return None if self.lifted_ns is None else (self.lifted_ns - self._tapped_ns) / SECOND
