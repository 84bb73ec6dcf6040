"""Parts of the phases that need no world: the next leg, the claw's aim, what is remembered of a size, the way
back, and the target that is tapped by where it is.
"""

import math
from dataclasses import replace

import numpy as np
import pytest

from tapreach.errors import InputError
from tapreach.geometry.planar_motion import PlanarPose, PlanarStep
from tapreach.tasks.fetch.after import _places_back, _step_to
from tapreach.tasks.fetch.approach import Leg
from tapreach.tasks.fetch.approaching import LONGEST_LEG, next_leg
from tapreach.tasks.fetch.fetch_state import FetchState, Mode
from tapreach.tasks.fetch.known_target import tap_on
from tapreach.tasks.fetch.memory import FetchMemory
from tapreach.tasks.fetch.preview import preview
from tapreach.tasks.fetch.states import STATES, Phase
from tapreach.tasks.fetch.thing import Thing
from tapreach.tasks.target import Target, TargetSource
from tapreach.tasks.task import Tap
from tasks.fetch.worlds import ROBOT, size_at
from tasks.rig import bare_context


def planned(x: float, y: float):
    size = size_at(x, y)
    found = preview(Thing(size.axis_in_world, size.axis_cov_in_world, size), [], PlanarPose(), ROBOT)
    assert found.approach is not None
    return found.approach


def test_far_things_are_driven_up_to_in_pieces_and_near_ones_not_at_all() -> None:
    way = planned(2.0, 0.4)
    leg = next_leg(way)
    assert leg is not None and leg.step.advance == pytest.approx(LONGEST_LEG)
    assert leg.step.turn == pytest.approx(way.legs[0].step.turn)
    arrived = replace(way, legs=(Leg(PlanarStep(math.radians(1.0), 0.01), 1.0, True),))
    assert next_leg(arrived) is None


def test_turn_alone_is_a_leg() -> None:
    way = replace(planned(2.0, 0.4), legs=(Leg(PlanarStep(math.radians(30.0), 0.0), 1.0, True),))
    leg = next_leg(way)
    assert leg is not None and leg.step == PlanarStep(math.radians(30.0), 0.0)


def test_way_back_ends_where_it_was_called() -> None:
    places = PlanarPose(), PlanarPose(0.4, 0.1, 0.2), PlanarPose(0.9, 0.3, 0.4)
    memory = FetchMemory(Tap(1, 1.0, 1.0), 1, Mode.GO, called_from=places[0], way=places[1:])
    assert _places_back(memory) == [places[2], places[1], places[0]]
    here = PlanarPose(1.2, 0.5, 0.5)
    for place in _places_back(memory):
        here = here.after(_step_to(here, place))
        assert math.hypot(here.x - place.x, here.y - place.y) < 0.02


def test_place_where_it_stands_already_needs_no_step() -> None:
    here = PlanarPose(1.0, 1.0, 2.0)
    assert _step_to(here, replace(here, heading=0.0)) == PlanarStep(0.0, 0.0)


def test_state_tells_what_is_next_and_after_a_stop_how_the_robot_stands() -> None:
    going = FetchState(Phase.APPROACH, 1)
    assert going.next_in_words == STATES[Phase.LAST_LOOK].does
    assert (going.condition, going.may_resume) == ("", False)
    stopped = replace(going, stopped="stopped by Anna")
    assert stopped.condition == STATES[Phase.APPROACH].if_stopped
    assert stopped.may_resume and not stopped.may_confirm
    held = FetchState(Phase.HELD, 1)
    assert (held.next_in_words, held.may_resume) == ("", False)


def test_only_a_fetch_that_waits_can_be_confirmed() -> None:
    assert FetchState(Phase.CONFIRM, 1).may_confirm
    assert not FetchState(Phase.CONFIRM, 1, stopped="stopped").may_confirm
    assert not FetchState(Phase.ZERO, 1).may_confirm


def test_known_target_outside_the_picture_is_refused() -> None:
    context = bare_context()
    context.poses.add(1, PlanarPose())
    behind = Target(
        3, TargetSource.LOCATE, "determined", "", "", 1, 0.0, 0.0, np.array([-1.0, 0.0, 0.1]), None, 1.0, None
    )
    with pytest.raises(InputError, match="target 3 is not in the picture"):
        tap_on(context, behind)
