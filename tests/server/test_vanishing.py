"""The five ways in which an operator vanishes, on real sockets. The last command never stands.

The robot's clock is turned by the test, so the timeouts are exact; only the sockets take real time.
"""

import socket
import struct

import pytest

from tapreach.robot.clock import MS, SECOND

PERIOD = 20 * MS


async def assert_rest_now_and_later(here):
    """The wheels stand, and go on standing, and the lease is free or idle in time."""
    await here.clock.advance(2 * PERIOD)
    assert here.speed == 0.0
    way = here.robot.base.odometry.distance
    here.robot.frames.is_running = False
    await here.clock.advance(10 * SECOND)
    assert here.robot.base.odometry.distance == way


def test_closed_socket_stops_at_once_and_frees_the_lease(play):
    async def scenario(here):
        page = await here.driver()
        await here.hold(page, SECOND)
        assert here.speed > 0.1
        now_ns = here.clock.now_ns()
        await page.close()
        await here.eventually(lambda: here.station.lease.status.holder_id is None)
        assert here.clock.now_ns() == now_ns
        assert here.station.loop.sent.twist.is_zero
        await assert_rest_now_and_later(here)

    play(scenario)


def test_reset_connection_stops_at_once_and_frees_the_lease(play):
    async def scenario(here):
        page = await here.driver()
        await here.hold(page, SECOND)
        raw = page.socket.transport.get_extra_info("socket")
        # Closing with a linger time of zero sends RST.
        raw.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
        page.socket.transport.abort()
        await here.eventually(lambda: here.station.lease.status.holder_id is None)
        assert here.station.loop.sent.twist.is_zero
        await assert_rest_now_and_later(here)

    play(scenario)


def test_silent_loss_stops_after_200_ms(play):
    async def scenario(here):
        page = await here.driver()
        await here.hold(page, SECOND)
        assert here.speed > 0.1
        # Nothing more arrives, and no end either: the cable is out. 50 ms have passed since the last message.
        await here.clock.advance(140 * MS)
        assert here.speed > 0.1
        await here.clock.advance(10 * MS + 2 * PERIOD)
        assert here.speed == 0.0
        await assert_rest_now_and_later(here)
        assert here.station.lease.status.is_idle

    play(scenario)


def test_frozen_tab_whose_socket_still_answers_stops_after_200_ms(play):
    async def scenario(here):
        page = await here.driver()
        await here.hold(page, SECOND)
        for _ in range(4):
            # The browser's network process answers pings of the protocol, and our own too.
            await (await page.socket.ping())
            await page.ask("ping", client_ms=here.clock.now_ns() / MS)
            await here.clock.advance(50 * MS)
        await here.clock.advance(PERIOD)
        assert here.speed == 0.0
        await assert_rest_now_and_later(here)

    play(scenario)


def test_live_link_that_delivers_old_input_stops_and_says_why(play):
    async def scenario(here):
        page = await here.driver()
        await here.hold(page, SECOND)
        for _ in range(8):
            answer = await page.drive(client_ms=here.clock.now_ns() / MS - 250, frame_id=here.newest_id)
            assert not answer["ok"]
            assert answer["reason"].startswith(("command 249 ms old", "command 250 ms old"))
            await here.clock.advance(50 * MS)
        assert here.speed == 0.0

    play(scenario)


def test_old_heartbeats_do_not_keep_a_task_alive(play):
    async def scenario(here):
        page = await here.driver()
        await page.act("heartbeat")
        assert here.station.deadman.is_alive
        await here.clock.advance(190 * MS)
        answer = await page.act("heartbeat", client_ms=here.clock.now_ns() / MS - 300)
        assert not answer["ok"]
        await here.clock.advance(20 * MS)
        assert not here.station.deadman.is_alive

    play(scenario)


def test_heartbeats_without_drive_messages_do_not_keep_the_wish(play):
    async def scenario(here):
        page = await here.driver()
        await here.hold(page, SECOND)
        await here.beat(page, 300 * MS)
        assert here.speed == 0.0
        await assert_rest_now_and_later(here)

    play(scenario)


def test_command_that_names_an_old_picture_is_refused_and_stops(play):
    async def scenario(here):
        page = await here.driver()
        await here.hold(page, SECOND)
        old_id = here.newest_id
        here.robot.frames.is_running = False
        await here.clock.advance(20 * MS)
        await here.hold(page, 400 * MS)
        await here.clock.advance(100 * MS)
        answer = await page.drive(frame_id=old_id)
        assert not answer["ok"]
        assert answer["reason"].startswith("picture 5")
        assert answer["sent"] == {"linear": 0.0, "angular": 0.0}
        await assert_rest_now_and_later(here)

    play(scenario)


def test_stop_of_the_operator_is_zero_at_once_and_says_what_was_sent(play):
    async def scenario(here):
        page = await here.driver()
        await here.hold(page, SECOND)
        answer = await page.ask("stop", reason="release")
        assert answer["ok"]
        assert answer["sent"] == {"linear": 0.0, "angular": 0.0}
        assert here.station.loop.sent.twist.is_zero
        await assert_rest_now_and_later(here)

    play(scenario)


@pytest.mark.parametrize("leave", ["close", "release"])
def test_who_asked_gets_the_lease_when_the_driver_leaves_and_starts_from_rest(play, leave):
    async def scenario(here):
        anna = await here.driver("Anna")
        ben = await here.page("Ben")
        await here.hold(anna, SECOND)
        assert not (await ben.ask("lease_request"))["ok"]
        await anna.until(lambda: anna.news.get("state", {}).get("lease", {}).get("asked_by_name") == "Ben")
        if leave == "close":
            await anna.close()
        else:
            await anna.ask("lease_release")
        await ben.until(lambda: ben.news["state"]["lease"]["holder_name"] == "Ben")
        assert here.station.loop.sent.twist.is_zero
        await assert_rest_now_and_later(here)

    play(scenario)


def test_driving_without_the_lease_is_refused_and_moves_nothing(play):
    async def scenario(here):
        await here.driver("Anna")
        ben = await here.page("Ben")
        answer = await ben.drive(frame_id=here.newest_id)
        assert not answer["ok"]
        assert "lease" in answer["reason"]
        await assert_rest_now_and_later(here)

    play(scenario)


def test_robot_lost_while_driving_is_told_and_commands_are_refused(play):
    async def scenario(here):
        page = await here.driver()
        await here.hold(page, SECOND)
        here.robot.lose("cable out")
        await page.until(lambda: page.news["state"]["health"] == "lost")
        assert page.news["state"]["health_reason"] == "cable out"
        answer = await page.drive(frame_id=here.newest_id)
        assert not answer["ok"]
        assert "cable out" in answer["reason"]
        await here.clock.advance(SECOND)
        assert here.speed == 0.0

    play(scenario)


def test_emergency_stop_of_a_watcher_holds_until_the_driver_resets_it(play):
    async def scenario(here):
        anna = await here.driver("Anna")
        ben = await here.page("Ben")
        await here.hold(anna, SECOND)
        answer = await ben.ask("emergency_stop")
        assert answer["ok"]
        assert answer["sent"] == {"linear": 0.0, "angular": 0.0}
        refused = await anna.drive(frame_id=here.newest_id)
        assert "pressed by Ben" in refused["reason"]
        assert not (await ben.ask("emergency_reset"))["ok"]
        assert (await anna.ask("emergency_reset"))["ok"]
        await here.clock.advance(100 * MS)
        assert here.speed == 0.0, "a reset alone must not move anything"
        await here.hold(anna, 200 * MS)
        assert here.speed > 0.0

    play(scenario)


def test_emergency_stop_says_when_the_robot_cannot_hear_it(play):
    async def scenario(here):
        page = await here.page()
        here.robot.lose("cable out")
        answer = await page.ask("emergency_stop")
        assert not answer["ok"]
        assert "not confirmed by the robot" in answer["reason"]
        assert here.station.emergency_stop.is_set

    play(scenario)
