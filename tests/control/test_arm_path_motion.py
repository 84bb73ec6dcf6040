"""The arm led along timed poses: on a fake arm whose servos run at their own speed, and by hand."""

from itertools import pairwise
from math import radians

import pytest

from tapreach.control.arm_path_motion import ArmPathMotion, TimedPose, between
from tapreach.control.motion import Progress, Senses
from tapreach.drivers.fake import FakeArm
from tapreach.errors import InputError, LinkLost
from tapreach.robot.clock import MS, SECOND, ManualClock
from tapreach.robot.messages import STILL, ArmPose, ArmState

START = ArmPose(0.0, 0.2, 0.6, 0.06)
MIDDLE = ArmPose(0.1, 0.5, 0.5, 0.06)
END = ArmPose(0.1, 0.9, 0.3, 0.02)
PATH = (TimedPose(0.0, START), TimedPose(0.5, MIDDLE), TimedPose(1.5, END))


class Led:
    """A motion over a fake arm, stepped every 20 ms."""

    def __init__(self, clock, description, path=PATH):
        self.clock = clock
        self.arm = FakeArm(clock, description.arm, lambda: None)
        self.arm.state = ArmState(clock.now_ns(), path[0].pose, path[0].pose, False)
        self.sent = []
        self.motion = ArmPathMotion(self.send, path)
        self.twists = []

    def send(self, pose):
        self.sent.append((self.clock.now_ns(), pose))
        return self.arm.move(pose)

    def run(self, most_s=10.0):
        states, end_ns = [], self.clock.now_ns() + round(most_s * SECOND)
        while self.motion.progress is Progress.MOVING and self.clock.now_ns() < end_ns:
            self.twists.append(self.motion.step(Senses(None, self.arm.state), self.clock.now_ns()))
            self.clock.turn(20 * MS)
            self.arm.step()
            states.append(self.arm.state)
        return states


def test_arm_is_at_each_pose_at_its_time_and_ends_at_rest(clock, description):
    led, start_ns = Led(clock, description), clock.now_ns()
    states = led.run()
    assert led.motion.progress is Progress.ARRIVED
    assert led.arm.state.pose == END
    assert not led.arm.state.is_moving
    at = {timed.time: timed.pose for timed in PATH}
    for time, pose in at.items():
        state = min(states, key=lambda s: abs(s.captured_ns - start_ns - 20 * MS - time * SECOND))
        assert state.pose.shoulder == pytest.approx(pose.shoulder, abs=0.02)
        assert state.pose.claw == pytest.approx(pose.claw, abs=0.002)
    assert 1.5 < (clock.now_ns() - start_ns) / SECOND < 1.5 + 0.5
    assert set(led.twists) == {STILL}


def test_no_joint_is_led_faster_than_the_path_says(clock, description):
    led = Led(clock, description)
    led.run()
    swiftest = (MIDDLE.shoulder - START.shoulder) / 0.5
    assert swiftest < radians(description.arm.speed_deg_s)
    for (earlier_ns, earlier), (later_ns, later) in pairwise(led.sent):
        elapsed = (later_ns - earlier_ns) / SECOND
        assert abs(later.shoulder - earlier.shoulder) <= swiftest * elapsed + 1e-9


def test_path_of_one_pose_is_a_plain_move(clock, description):
    led = Led(clock, description, (TimedPose(0.0, END),))
    led.arm.state = ArmState(clock.now_ns(), START, START, False)
    led.run()
    assert led.motion.progress is Progress.ARRIVED
    assert led.arm.state.pose == END


def test_lost_link_on_the_way_gives_up_with_its_reason():
    def send(_: ArmPose) -> ArmPose:
        raise LinkLost("the cable was pulled")

    clock, motion = ManualClock(), ArmPathMotion(send, PATH)
    assert motion.moves_arm, "so that the loop holds the arm when it is ended early"
    assert motion.step(Senses(), clock.now_ns()) == STILL
    assert motion.progress is Progress.GIVEN_UP
    assert motion.reason == "the cable was pulled"


@pytest.mark.parametrize("times", [(), (0.0, 0.0), (1.0, 0.5)])
def test_times_that_do_not_rise_are_refused(times):
    with pytest.raises(InputError, match="times"):
        ArmPathMotion(lambda pose: pose, [TimedPose(time, START) for time in times])


def test_pose_between_two_is_the_share_of_each_joint():
    assert between(START, END, 0.0) == START
    half = between(START, END, 0.5)
    assert (half.rotation, half.shoulder, half.elbow) == pytest.approx((0.05, 0.55, 0.45))
    assert half.claw == pytest.approx(0.04)
