"""One driver at a time, under every order of asking, answering and leaving."""

import pytest
from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, invariant, rule

from tapreach.control.lease import ANSWER_NS, IDLE_NS, Lease
from tapreach.robot.clock import MS, ManualClock

ANNA, BEN, CLEO = 1, 2, 3


@pytest.fixture
def lease(clock: ManualClock) -> Lease:
    return Lease(clock)


def test_free_lease_is_granted_at_once(lease):
    assert lease.request(ANNA).is_granted
    assert lease.is_held_by(ANNA)
    assert not lease.is_held_by(BEN)


def test_nobody_holds_a_lease_that_was_not_requested(lease):
    assert lease.status.holder_id is None
    assert not lease.is_held_by(ANNA)


def test_second_request_asks_the_holder_and_says_so(lease):
    lease.request(ANNA)
    reply = lease.request(BEN)
    assert not reply.is_granted
    assert "asked" in reply.reason
    assert lease.status.asked_by_id == BEN
    assert lease.is_held_by(ANNA)


def test_granted_ask_hands_over(lease):
    lease.request(ANNA)
    lease.request(BEN)
    assert lease.answer(ANNA, BEN, grant=True).is_granted
    assert lease.is_held_by(BEN)
    assert lease.status.asked_by_id is None


def test_refused_ask_leaves_the_holder(lease, clock):
    lease.request(ANNA)
    lease.request(BEN)
    lease.answer(ANNA, BEN, grant=False)
    clock.turn(ANSWER_NS)
    lease.tick()
    assert lease.is_held_by(ANNA)
    assert lease.status.asked_by_id is None


@pytest.mark.parametrize("who", [BEN, CLEO])
def test_only_the_holder_may_answer(lease, who):
    lease.request(ANNA)
    lease.request(BEN)
    assert not lease.answer(who, BEN, grant=True).is_granted
    assert lease.is_held_by(ANNA)


def test_answer_to_somebody_who_does_not_ask_changes_nothing(lease):
    lease.request(ANNA)
    assert not lease.answer(ANNA, BEN, grant=True).is_granted
    assert lease.is_held_by(ANNA)


def test_unanswered_ask_is_granted_after_five_seconds_and_not_before(lease, clock):
    lease.request(ANNA)
    lease.request(BEN)
    clock.turn(ANSWER_NS - 1)
    lease.tick()
    assert lease.is_held_by(ANNA)
    clock.turn(1)
    lease.tick()
    assert lease.is_held_by(BEN)


def test_holder_who_goes_on_driving_keeps_the_lease_through_an_ask(lease, clock):
    lease.request(ANNA)
    lease.request(BEN)
    for _ in range(20):
        clock.turn(ANSWER_NS - MS)
        lease.command_given(ANNA)
        lease.tick()
    assert lease.is_held_by(ANNA)


def test_idle_lease_is_taken_without_asking(lease, clock):
    lease.request(ANNA)
    clock.turn(IDLE_NS - 1)
    assert not lease.status.is_idle
    clock.turn(1)
    assert lease.status.is_idle
    assert lease.request(BEN).is_granted
    assert lease.is_held_by(BEN)


def test_commands_of_somebody_else_do_not_keep_the_lease_busy(lease, clock):
    lease.request(ANNA)
    clock.turn(IDLE_NS)
    lease.command_given(BEN)
    assert lease.status.is_idle


def test_leaving_holder_frees_the_lease(lease):
    lease.request(ANNA)
    lease.leave(ANNA)
    assert lease.status.holder_id is None


def test_leaving_holder_passes_the_lease_to_who_asked(lease):
    lease.request(ANNA)
    lease.request(BEN)
    lease.leave(ANNA)
    assert lease.is_held_by(BEN)


def test_leaving_asker_withdraws_the_ask(lease, clock):
    lease.request(ANNA)
    lease.request(BEN)
    lease.leave(BEN)
    clock.turn(ANSWER_NS)
    lease.tick()
    assert lease.is_held_by(ANNA)


def test_third_one_is_told_that_somebody_else_has_asked(lease):
    lease.request(ANNA)
    lease.request(BEN)
    assert "somebody else" in lease.request(CLEO).reason
    assert lease.status.asked_by_id == BEN


class LeaseMachine(RuleBasedStateMachine):
    """Any order of events: changes are always told, and nobody asks himself."""

    sessions = st.integers(1, 3)

    def __init__(self) -> None:
        super().__init__()
        self.clock = ManualClock()
        self.told = None
        self.lease = Lease(self.clock, self.note)

    def note(self) -> None:
        self.told = (self.lease.status.holder_id, self.lease.status.asked_by_id)

    @rule(who=sessions)
    def request(self, who):
        if self.lease.request(who).is_granted:
            assert self.lease.is_held_by(who)

    @rule(who=sessions)
    def leave(self, who):
        self.lease.leave(who)
        assert not self.lease.is_held_by(who)
        assert self.lease.status.asked_by_id != who

    @rule(who=sessions, asker=sessions, grant=st.booleans())
    def answer(self, who, asker, grant):
        self.lease.answer(who, asker, grant)

    @rule(who=sessions)
    def command(self, who):
        self.lease.command_given(who)

    @rule(duration_ns=st.integers(0, 2 * IDLE_NS))
    def wait(self, duration_ns):
        self.clock.turn(duration_ns)
        self.lease.tick()

    @invariant()
    def every_change_was_told(self):
        status = self.lease.status
        assert (status.holder_id, status.asked_by_id) == (self.told or (None, None))

    @invariant()
    def holder_does_not_ask(self):
        status = self.lease.status
        assert status.asked_by_id is None or status.asked_by_id != status.holder_id
        assert status.asked_by_id is None or status.holder_id is not None


TestLeaseMachine = LeaseMachine.TestCase
TestLeaseMachine.settings = settings(max_examples=60, stateful_step_count=30, deadline=None)
