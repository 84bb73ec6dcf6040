"""What is not seen any more and was doubtful is not driven at."""

from dataclasses import replace

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import RigidTransform

from tapreach.geometry.seen_arm import SeenArm
from tapreach.tasks.fetch.claw_room import Claw
from tapreach.tasks.fetch.reach import OFF_FLOOR, Verdict, judge
from tapreach.tasks.fetch.thing import NoSize, Thing
from tapreach.tasks.fetch.unseen import refused_unseen
from tasks.fetch.worlds import BODY, thing_at

CLAW = BODY.claw


@settings(max_examples=60, deadline=None)
@given(st.floats(0.03, 0.12), st.floats(0.0, 0.02), st.floats(0.0, 0.2))
def test_only_what_was_doubtful_and_is_lost_is_refused(width, width_sd, foot):
    thing = thing_at(1.0, 0.0, width=width, width_sd=width_sd, foot=foot)
    judged = judge(thing.size, CLAW)
    lost = refused_unseen(thing, CLAW, "it has left the picture")
    assert refused_unseen(thing, CLAW, "") == ""
    if judged.verdict is Verdict.YES:
        assert lost == ""
    if judged.verdict is not Verdict.YES and foot > OFF_FLOOR:
        assert judged.reason in lost and "it has left the picture" in lost


def test_width_that_is_known_badly_alone_is_no_reason():
    doubtful = thing_at(1.0, 0.0, width=0.06, width_sd=0.007)
    assert judge(doubtful.size, CLAW).verdict is Verdict.UNSURE
    assert refused_unseen(doubtful, CLAW, "hidden") == ""
    assert refused_unseen(Thing(np.zeros(3), np.eye(3), NoSize("unknown")), CLAW, "hidden") == ""


def test_too_wide_from_here_is_not_looked_at_from_elsewhere_unseen():
    assert "too wide" in refused_unseen(thing_at(1.0, 0.0, width=0.085), CLAW, "hidden")


def test_arm_that_was_seen_to_stand_off_its_file_is_judged_as_well():
    seen = SeenArm(CLAW.arm.kinematics, np.array([0.02, -0.01, 0.03]), RigidTransform.identity())
    claw = Claw(replace(CLAW.arm, kinematics=seen))
    assert judge(thing_at(0.6, 0.0).size, claw).verdict is Verdict.YES
