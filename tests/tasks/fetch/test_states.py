"""The table of fetching is whole: every state can be reached, every way comes to an end."""

import inspect
import re

import pytest

from tapreach.errors import InputError
from tapreach.tasks.fetch.states import (
    ATTEMPTS,
    FIRST,
    STATES,
    Outcome,
    Phase,
    is_end,
    next_phase,
    resumed_at,
)
from tapreach.tasks.fetch.task import _STEPS


def _reached_from(start: Phase) -> set[Phase]:
    reached, to_visit = {start}, [start]
    while to_visit:
        new = set(STATES[to_visit.pop()].after.values()) - reached
        reached |= new
        to_visit += new
    return reached


def test_every_state_is_in_the_table_and_can_be_reached() -> None:
    assert set(STATES) == set(Phase)
    assert _reached_from(FIRST) == set(Phase)


def test_every_state_can_come_to_an_end() -> None:
    for phase in Phase:
        assert any(is_end(reached) for reached in _reached_from(phase)), phase


def test_a_stopped_state_says_how_the_robot_stands_and_where_it_goes_on() -> None:
    for phase, state in STATES.items():
        if not is_end(phase):
            assert state.if_stopped, phase
            resumed = resumed_at(phase)
            assert resumed is not None and not is_end(resumed), phase


def test_after_the_last_attempt_a_miss_is_a_failure() -> None:
    assert next_phase(Phase.VERIFY, Outcome.MISSED, attempts=1) is Phase.BACK_OFF
    assert next_phase(Phase.VERIFY, Outcome.MISSED, attempts=ATTEMPTS) is Phase.FAILED


def test_the_claw_never_closes_before_the_reach_nor_on_a_refused_thing() -> None:
    into_grip = {phase for phase, state in STATES.items() if Phase.GRIP in state.after.values()}
    assert into_grip == {Phase.REACH}
    assert _reached_from(Phase.REFUSED) == {Phase.REFUSED}


def test_an_outcome_that_a_state_does_not_have_is_refused() -> None:
    with pytest.raises(InputError, match="grip cannot end as lost; it ends as: done"):
        next_phase(Phase.GRIP, Outcome.LOST, attempts=0)


def test_progress_only_falls_when_it_tries_again() -> None:
    for phase, state in STATES.items():
        for outcome, following in state.after.items():
            rises = STATES[following].progress >= state.progress
            anew = (Outcome.MISSED, Outcome.CANNOT, Outcome.UNSURE)
            tries_again = phase is Phase.BACK_OFF or outcome in anew
            assert rises or tries_again, (phase, outcome)


@pytest.mark.parametrize("phase", _STEPS)
def test_a_phase_ends_only_in_ways_that_the_table_has(phase: Phase) -> None:
    named = {Outcome[name] for name in re.findall(r"Outcome\.([A-Z_]+)", inspect.getsource(_STEPS[phase]))}
    assert named
    assert named <= set(STATES[phase].after), phase
