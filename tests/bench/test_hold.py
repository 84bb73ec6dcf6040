from tapreach.bench.control_hold import hold_of
from tapreach.bench.pattern_robot import SentTwist
from tapreach.robot.clock import MS
from tapreach.robot.messages import STILL, Twist

GO = Twist(0.2, 0.0)


def test_hold_counts_stops_and_not_their_length():
    twists = [GO, GO, STILL, STILL, STILL, GO, STILL, GO]
    hold = hold_of([SentTwist(index * 20 * MS, twist) for index, twist in enumerate(twists)])
    assert hold.stops == 2
    assert hold.seconds == 0.14


def test_hold_finds_the_longest_silence_of_the_loop():
    hold = hold_of([SentTwist(when * MS, GO) for when in (0, 20, 95, 110)])
    assert (hold.stops, hold.longest_gap_ms) == (0, 75)
