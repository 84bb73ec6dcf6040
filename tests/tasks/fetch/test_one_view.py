"""What a single view has told of the size counts where no better one is to come, and only there."""

import numpy as np

from tapreach.tasks.fetch.thing import NoSize, ThingSize
from tasks.fetch.looks import RED, run_after_look
from tasks.fetch.worlds import size_at


def test_size_by_one_view_is_taken_where_none_is_known() -> None:
    run, alone = run_after_look((RED, RED, RED)), size_at(0.6, 0.03, width=0.06)
    run.size = NoSize("the views disagree", by_one_view=alone)
    run.believe_one_view()
    assert isinstance(run.size, ThingSize) and run.size.width == alone.width
    thing = run.thing()
    assert isinstance(thing.size, ThingSize)
    np.testing.assert_allclose(thing.size.axis_in_world, alone.axis_in_world)


def test_it_replaces_nothing_that_is_known_and_makes_nothing_up() -> None:
    run, known = run_after_look((RED, RED, RED)), size_at(0.6, 0.03)
    run.size = known
    run.believe_one_view()
    assert run.size is known
    run.size = NoSize("it was not measured")
    run.believe_one_view()
    assert isinstance(run.size, NoSize)
