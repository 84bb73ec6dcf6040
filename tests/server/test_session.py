"""The control socket on the wire: every message answered once, and nothing it says ends the server."""

import asyncio
import json
import random
from typing import get_args

import pytest

from tapreach.robot.clock import MS, SECOND, MonotonicClock
from tapreach.server import messages
from tapreach.server.dispatch import answerers


def test_every_request_has_somebody_who_answers_it(play):
    async def scenario(here):
        union = get_args(messages.FromPage)[0]
        assert set(answerers(here.station)) == set(get_args(union))

    play(scenario)


def test_hello_is_answered_with_what_the_page_needs(play):
    async def scenario(here):
        page = await here.page(greet=False)
        welcome = await page.ask("hello", name="  Anna ")
        assert welcome["type"] == "welcome"
        assert welcome["protocol_version"] == messages.PROTOCOL_VERSION
        assert (welcome["camera"]["width"], welcome["camera"]["height"]) == (640, 480)
        assert welcome["max_linear"] == 0.35
        await page.until(lambda: "state" in page.news)
        assert here.station.guests.name_of(welcome["session_id"]) == "Anna"

    play(scenario)


def test_request_before_hello_is_refused_but_the_emergency_stop_is_not(play):
    async def scenario(here):
        page = await here.page(greet=False)
        refused = await page.ask("lease_request")
        assert (refused["ok"], refused["reason"]) == (False, "say hello before lease_request")
        assert (await page.ask("emergency_stop"))["ok"]
        assert here.station.emergency_stop.is_set

    play(scenario)


def test_ping_is_answered_with_the_servers_time(play):
    async def scenario(here):
        page = await here.page()
        pong = await page.ask("ping", client_ms=12.25)
        assert (pong["type"], pong["client_ms"]) == ("pong", 12.25)
        assert pong["server_ns"] == here.clock.now_ns()

    play(scenario)


def test_state_comes_ten_times_a_second_and_shows_what_was_sent(play):
    async def scenario(here):
        page = await here.driver()
        await here.hold(page, SECOND)
        await here.eventually(lambda: page.news["state"]["sent"]["linear"] == 0.2)
        before = page.news["state"]["server_ns"]
        await here.beat(page, 300 * MS)
        await page.until(lambda: page.news["state"]["server_ns"] > before)
        state = page.news["state"]
        assert state["sent"] == {"linear": 0.0, "angular": 0.0}
        assert state["odometry"]["x"] > 0.1
        assert state["lease"]["holder_name"] == "Anna"
        assert state["health"] == "running"

    play(scenario)


BROKEN = [
    "",
    "nonsense",
    "[]",
    "null",
    '{"type": "drive"}',
    '{"type": "drive", "seq": 5, "client_ms": NaN, "frame_id": 1, "linear": 1, "angular": 0}',
    '{"type": "tap", "seq": 6, "frame_id": 1, "u": Infinity, "v": 2, "purpose": "locate"}',
    '{"seq": 7}',
    "x" * 20_000,
    "[" * 10_000,
    b"\x00\x01\x02",
    b"",
]


@pytest.mark.parametrize("raw", BROKEN, ids=range(len(BROKEN)))
def test_broken_message_gets_one_refusal_and_the_socket_lives(play, raw):
    async def scenario(here):
        page = await here.page()
        await page.socket.send(raw)
        pong = await page.ask("ping", client_ms=1.0)
        assert pong["type"] == "pong"
        refusals = [ack for answers in page.answers.values() for ack in answers if ack.get("ok") is False]
        assert len(refusals) == 1
        assert refusals[0]["reason"]

    play(scenario)


def random_message(rng: random.Random) -> str | bytes:
    """Somewhere between right and noise."""
    union = get_args(get_args(messages.FromPage)[0])
    values = [None, True, 0, 1, -1, 7, 0.5, 1e308, "drive", "", [], {}, [[]], "é\u0000", 10**40]
    kind = rng.choice(union)
    fields = {name: rng.choice(values) for name in kind.model_fields if rng.random() < 0.8}
    fields |= {"type": rng.choice([kind.model_fields["type"].annotation.__args__[0], "nonsense"])}
    text = json.dumps(fields)
    if rng.random() < 0.3:
        cut = rng.randrange(len(text))
        text = text[:cut] + rng.choice(["", "\x00", "}", '"']) + text[cut + rng.randrange(3) :]
    return text.encode() if rng.random() < 0.1 else text


@pytest.mark.parametrize("seed", range(4))
def test_fuzzed_messages_get_exactly_one_answer_each_and_the_server_lives(play, seed):
    rng = random.Random(seed)
    count = 150

    async def scenario(here):
        page = await here.page()
        heard = sum(map(len, page.answers.values()))
        for _ in range(count):
            await page.socket.send(random_message(rng))
        await page.until(lambda: sum(map(len, page.answers.values())) - heard >= count)
        page.seq = 10**6
        assert (await page.ask("ping", client_ms=1.0))["type"] == "pong"
        assert sum(map(len, page.answers.values())) - heard == count + 1
        other = await here.page("Ben")
        assert (await other.ask("ping", client_ms=1.0))["type"] == "pong"
        assert here.station.failed is not None
        assert not here.station.failed.done()

    play(scenario, clock=MonotonicClock())


def test_flood_is_read_slowly_and_others_are_served_meanwhile(play):
    async def scenario(here):
        flooder, other = await here.page("flood"), await here.page("Ben")
        for number in range(600):
            await flooder.socket.send(json.dumps({"type": "ping", "seq": number + 10, "client_ms": 0}))
        assert (await other.ask("ping", client_ms=1.0))["type"] == "pong"
        # The clock stands: no more than the burst may have been read.
        assert sum(map(len, flooder.answers.values())) <= 201
        await here.clock.advance(SECOND)
        await flooder.until(lambda: sum(map(len, flooder.answers.values())) > 300)

    play(scenario)


def test_message_of_a_megabyte_closes_its_own_socket_only(play):
    async def scenario(here):
        page, other = await here.page(), await here.page("Ben")
        await page.socket.send("x" * 1_100_000)
        await asyncio.wait_for(page.socket.wait_closed(), 10)
        assert page.socket.close_code == 1009
        assert (await other.ask("ping", client_ms=1.0))["type"] == "pong"

    play(scenario)


def test_error_of_the_program_in_a_request_is_answered_and_logged(play, caplog):
    async def scenario(here):
        page = await here.page()

        def broken(frame_id):
            raise ZeroDivisionError("a bug")

        here.station.capture = broken
        answer = await page.ask("capture", frame_id=None)
        assert not answer["ok"]
        assert answer["reason"] == "capture met an error of the program; the log has the details"
        assert (await page.ask("ping", client_ms=1.0))["type"] == "pong"

    play(scenario)
    assert "a bug" in caplog.text


def test_arm_steps_add_up_from_the_last_target(play):
    async def scenario(here):
        page = await here.driver()
        for _ in range(3):
            assert (await page.act("arm_step", control="left", step_deg=10))["ok"]
        await here.beat(page, SECOND)
        assert here.robot.arm.state.pose.rotation == pytest.approx(0.5236, abs=1e-4)

    play(scenario)


def test_arm_step_at_the_limit_says_so(play):
    async def scenario(here):
        page = await here.driver()
        await page.act("arm_step", control="left", step_deg=50)
        await page.act("arm_step", control="left", step_deg=50)
        answer = await page.act("arm_step", control="left", step_deg=50)
        assert (answer["ok"], answer["reason"]) == (False, "left: the arm is at its limit")

    play(scenario)


def test_arm_of_somebody_else_is_not_moved(play):
    async def scenario(here):
        await here.driver("Anna")
        ben = await here.page("Ben")
        answer = await ben.act("arm_goto", pose="standard")
        assert not answer["ok"]
        assert not here.robot.arm.state.is_moving

    play(scenario)


def test_capture_is_stored_and_every_page_is_told(play):
    async def scenario(here):
        page, other = await here.driver(), await here.page("Ben")
        answer = await page.ask("capture", frame_id=None)
        assert answer["ok"]
        await other.until(lambda: other.news.get("captures_changed", {}).get("newest") == answer["reason"])
        facts = json.loads(here.station.captures.facts(answer["reason"]))
        assert facts["frame_id"] == here.newest_id
        assert facts["world_from_base"] == {"x": 0.0, "y": 0.0, "heading_deg": 0.0}

    play(scenario)


@pytest.mark.parametrize(("frame_id", "reason"), [(999, "there was no picture 999")])
def test_capture_of_an_unknown_picture_is_refused(play, frame_id, reason):
    async def scenario(here):
        page = await here.driver()
        answer = await page.ask("capture", frame_id=frame_id)
        assert not answer["ok"]
        assert reason in answer["reason"]

    play(scenario)


def test_lease_is_handed_over_when_the_holder_grants(play):
    async def scenario(here):
        anna, ben = await here.driver("Anna"), await here.page("Ben")
        asked = await ben.ask("lease_request")
        assert (asked["ok"], "asked" in asked["reason"]) == (False, True)
        await anna.until(lambda: anna.news["state"]["lease"]["asked_by_id"] is not None)
        ben_id = anna.news["state"]["lease"]["asked_by_id"]
        assert (await anna.ask("lease_answer", session_id=ben_id, grant=True))["ok"]
        await ben.until(lambda: ben.news["state"]["lease"]["holder_id"] == ben_id)
        assert not (await anna.drive(frame_id=here.newest_id))["ok"]

    play(scenario)
