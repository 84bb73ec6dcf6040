"""The outbox: answers in order and all, the rest newest wins, and never more than fits."""

import asyncio

from hypothesis import given
from hypothesis import strategies as st

from tapreach.server.hub import Hub
from tapreach.server.messages import TargetGone
from tapreach.server.outbox import MOST_ANSWERS, Outbox

keys = st.sampled_from(["state", "task", "target 1", "target 2", "guide"])
puts = st.lists(st.tuples(st.booleans(), keys, st.integers(0, 999)), max_size=100)


async def drained(outbox: Outbox) -> list[str]:
    return [await outbox.next() for _ in range(len(outbox))]


@given(puts)
def test_answers_all_come_in_order_and_of_each_key_only_the_newest(events):
    outbox, answers, newest = Outbox(), [], {}
    for is_answer, key, number in events:
        if is_answer:
            outbox.answer(f"answer {number}")
            answers.append(f"answer {number}")
        else:
            outbox.put(key, f"{key}: {number}")
            newest[key] = f"{key}: {number}"
    got = asyncio.run(drained(outbox))
    assert got[: len(answers)] == answers
    assert sorted(got[len(answers) :]) == sorted(newest.values())
    assert len(outbox) == 0


@given(st.lists(keys, max_size=300))
def test_a_page_that_reads_nothing_holds_one_text_per_key(told):
    outbox = Outbox()
    for number, key in enumerate(told):
        outbox.put(key, str(number))
    assert len(outbox) == len(set(told))


def test_next_waits_for_something_to_come():
    async def scenario():
        outbox = Outbox()
        waiting = asyncio.ensure_future(outbox.next())
        await asyncio.sleep(0)
        assert not waiting.done()
        outbox.put("state", "new")
        assert await waiting == "new"

    asyncio.run(scenario())


def test_there_is_no_room_for_more_answers_until_some_are_read():
    async def scenario():
        outbox = Outbox()
        for number in range(MOST_ANSWERS):
            outbox.answer(str(number))
        waiting = asyncio.ensure_future(outbox.room())
        await asyncio.sleep(0)
        assert not waiting.done()
        await outbox.next()
        await waiting

    asyncio.run(scenario())


def test_newcomer_is_told_what_stands_and_not_what_was_forgotten():
    hub, early, late = Hub(), Outbox(), Outbox()
    hub.join(early)
    hub.tell("target 1", TargetGone(target_id=1))
    hub.tell("target 2", TargetGone(target_id=2))
    hub.forget("target 1")
    hub.join(late)
    assert len(asyncio.run(drained(early))) == 2
    (text,) = asyncio.run(drained(late))
    assert '"target_id":2' in text


def test_who_has_left_is_told_nothing():
    hub, outbox = Hub(), Outbox()
    hub.join(outbox)
    hub.leave(outbox)
    hub.leave(outbox)
    hub.tell("state", TargetGone(target_id=1))
    assert len(outbox) == 0
