"""From the state of fetching to what the page is told and what is drawn into frames."""

import numpy as np

from tapreach.geometry.finite import FloatArray
from tapreach.server.messages_fetch import FetchView
from tapreach.tasks.fetch.fetch_state import FetchPlan, FetchState
from tapreach.tasks.fetch.states import STATES


def fetch_view(state: FetchState) -> FetchView:
    """Return the state for the page."""
    row = STATES[state.phase]
    return FetchView(
        phase=state.phase.value,
        target_id=state.target_id,
        does=row.does,
        why=state.why,
        next=state.next_in_words,
        progress=row.progress,
        attempt=state.attempt,
        may_confirm=state.may_confirm,
        may_resume=state.may_resume,
        stopped=state.stopped,
        condition=state.condition,
        verbs=tuple(verb.value for verb in state.verbs),
        **(_plan_fields(state.plan) if state.plan is not None else {}),
    )


def plan_lines_in_world(plan: FetchPlan | None) -> list[FloatArray]:
    """Return what is to be drawn of a plan into frames: the way of the base's middle on the floor, and the
    claw at the thing, (n, 3) [m] each.
    """
    if plan is None:
        return []
    way = np.array([(pose.x, pose.y, 0.0) for pose in plan.path])
    return [*([way] if len(way) > 1 else []), *plan.grasp_lines_in_world]


def _plan_fields(plan: FetchPlan) -> dict[str, object]:
    return {
        "verdict": plan.verdict.value,
        "reason": plan.reason,
        "advice": plan.advice,
        "seconds": plan.seconds,
        "path": tuple((pose.x, pose.y, pose.heading) for pose in plan.path),
        "grasp": tuple(tuple((float(x), float(y)) for x, y, _ in line) for line in plan.grasp_lines_in_world),
    }
