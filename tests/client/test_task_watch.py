"""From what the server says, in whatever order newest-wins leaves, to how a task ended."""

import itertools

import pytest

from tapreach.client.fetching import FetchStatus, _result
from tapreach.client.task_watch import TaskWatch
from tapreach.errors import TapreachError
from tapreach.server.messages import TaskView
from tapreach.server.messages_fetch import FetchView

STATE = {"type": "state"}


def task(state, message="so it ended"):
    view = TaskView(task_id=3, kind="fetch", state=state, phase="look", progress=0.5, message=message)
    return view.model_dump(mode="json")


def phase(name, **fields):
    return FetchView(phase=name, target_id=1, **fields).model_dump(mode="json")


def told(*messages, is_fetch=True):
    watch = TaskWatch(is_fetch)
    watch.begin()
    for message in messages:
        watch.hear(message)
    return watch


def test_what_was_said_before_the_answer_is_of_something_else():
    watch = TaskWatch(is_fetch=True)
    for message in (task("done"), phase("held")):
        watch.hear(message)
    assert watch.task is None and not watch.phases
    with pytest.raises(TapreachError, match="not ended"):
        watch.result()


@pytest.mark.parametrize("order", [*itertools.permutations([task("done"), phase("held"), STATE])])
def test_end_is_told_in_any_order_when_its_last_phase_is_there(order):
    assert not told(*order[:1]).is_told
    assert told(*order).is_told


def test_end_without_a_last_phase_is_told_after_two_rounds_of_state():
    news = [task("running"), phase("look"), STATE, STATE, task("cancelled"), STATE]
    assert not told(*news).is_told
    assert told(*news, STATE).is_told


def test_phase_of_an_earlier_fetch_does_not_end_another_task():
    assert not told(phase("held"), task("done"), is_fetch=False).is_told


@pytest.mark.parametrize(
    ("end", "last", "status", "reason"),
    [
        ("done", phase("held", why="it moves with the claw"), FetchStatus.HELD, "it moves with the claw"),
        ("done", phase("planned", why="fine"), FetchStatus.PLANNED, "fine"),
        ("done", phase("refused", why="28 mm too wide"), FetchStatus.REFUSED, "28 mm too wide"),
        ("failed", phase("failed", why="x"), FetchStatus.FAILED, "so it ended"),
        ("failed", phase("look", stopped="so it ended"), FetchStatus.FAILED, "so it ended"),
        ("cancelled", phase("grip", stopped="so it ended"), FetchStatus.STOPPED, "so it ended"),
    ],
)
def test_status_and_reason_are_those_of_the_end(end, last, status, reason):
    result = _result(told(task("running"), last, task(end)))
    assert (result.status, result.reason) == (status, reason)
    assert result.is_held == (status is FetchStatus.HELD)
    assert result.last is not None and result.last.phase == last["phase"]
