"""Whether it is held: what counts where the claw tells, where it does not, and where it was never seen."""

import asyncio
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from tapreach.estimation.arm_offsets import NoOffsets
from tapreach.robot.messages import ArmPose
from tapreach.tasks.fetch import verifying
from tapreach.tasks.fetch.arm_workspace import ArmWorkspace
from tapreach.tasks.fetch.arm_zero import ArmZero
from tapreach.tasks.fetch.held import Held, HeldVerdict
from tapreach.tasks.fetch.run import FetchRun
from tapreach.tasks.fetch.states import Outcome
from tasks.fetch.looks import GREEN, HERE, MIDDLE, RED, frame, run_after_look
from tasks.fetch.worlds import ROBOT

LIFTED = ROBOT.arm.standard.pose()
CLOSED = replace(LIFTED, claw=0.0)


@dataclass
class Moves:
    """A pilot that notes where the base and the arm are sent."""

    advances: list[float] = field(default_factory=list)
    arms: list[ArmPose] = field(default_factory=list)

    async def advance(self, distance: float, share: float = 1.0) -> None:
        self.advances.append(distance)

    async def move_arm(self, pose: ArmPose) -> None:
        self.arms.append(pose)


class HeldUp:
    """An arm whose claw was told to close."""

    async def target(self) -> ArmPose:
        return CLOSED


@pytest.fixture
def fetch(monkeypatch: pytest.MonkeyPatch) -> tuple[FetchRun, Moves]:
    run, moves = run_after_look((RED, RED, RED)), Moves()
    run.arm_watch = HeldUp()  # type: ignore[assignment]
    object.__setattr__(run.context, "pilot", moves)
    monkeypatch.setattr(verifying, "lacking_room", lambda run: 0.1)
    monkeypatch.setattr(verifying, "way_behind", lambda poses: 0.06)
    return run, moves


def shown(
    monkeypatch: pytest.MonkeyPatch, colour: tuple[int, int, int], place: NDArray[np.float64] = MIDDLE
) -> None:
    """From now on the camera shows a thing of that colour there, or where the thing stood."""

    async def newest(context: Any) -> Any:
        return frame(place, colour)

    async def here(context: Any, captured_ns: int) -> Any:
        return HERE

    monkeypatch.setattr(verifying, "frame_from_now_on", newest)
    monkeypatch.setattr(verifying, "pose_at", here)


def claw_tells(monkeypatch: pytest.MonkeyPatch, run: FetchRun, held: Held) -> None:
    async def look(*_: object) -> Held:
        return held

    monkeypatch.setattr(verifying, "look_whether_held", look)
    run.remember(zero=ArmZero(NoOffsets("not asked here"), 4))


def test_claw_never_seen_is_believed_unless_the_thing_still_stands_there(
    fetch: tuple[FetchRun, Moves], monkeypatch: pytest.MonkeyPatch
) -> None:
    run, _ = fetch
    shown(monkeypatch, GREEN)
    assert asyncio.run(verifying.verify(run)).outcome is Outcome.DONE
    shown(monkeypatch, RED)
    assert asyncio.run(verifying.verify(run)).outcome is Outcome.MISSED


def test_what_is_alike_but_elsewhere_denies_nothing(
    fetch: tuple[FetchRun, Moves], monkeypatch: pytest.MonkeyPatch
) -> None:
    """As is the thing itself, held up before the camera."""
    run, _ = fetch
    shown(monkeypatch, RED, np.add(MIDDLE, [0.0, 0.12, 0.06]))
    assert asyncio.run(verifying.verify(run)).outcome is Outcome.DONE


def test_claw_never_seen_is_held_away_by_the_robot_file_to_see_past_it(
    fetch: tuple[FetchRun, Moves], monkeypatch: pytest.MonkeyPatch
) -> None:
    run, moves = fetch
    shown(monkeypatch, GREEN)
    asyncio.run(verifying.verify(run))
    away, after = moves.arms
    mount, tip = ROBOT.camera.mount, ArmWorkspace.of(ROBOT).tip(away)
    assert tip[2] > mount.up and tip[1] < mount.left - 0.05 and away.claw == CLOSED.claw
    assert after == CLOSED


@pytest.mark.parametrize(("colour", "outcome"), [(GREEN, Outcome.DONE), (RED, Outcome.MISSED)])
def test_where_fingers_seem_apart_but_it_is_not_sure_the_place_tells(
    colour: tuple[int, int, int],
    outcome: Outcome,
    fetch: tuple[FetchRun, Moves],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    run, _ = fetch
    run.recall_size()
    claw_tells(monkeypatch, run, Held(HeldVerdict.UNSURE, "something else moved", 0.045, 0.0))
    shown(monkeypatch, colour)
    assert asyncio.run(verifying.verify(run)).outcome is outcome


def test_where_fingers_may_have_met_what_is_not_sure_is_not_held(
    fetch: tuple[FetchRun, Moves], monkeypatch: pytest.MonkeyPatch
) -> None:
    run, _ = fetch
    run.recall_size()
    claw_tells(monkeypatch, run, Held(HeldVerdict.UNSURE, "something else moved", 0.005, 0.0))
    shown(monkeypatch, GREEN)
    assert asyncio.run(verifying.verify(run)).outcome is Outcome.MISSED


@pytest.mark.parametrize("verdict", [HeldVerdict.HELD, HeldVerdict.NOT_HELD])
def test_it_backs_off_over_free_floor_and_comes_back_with_what_it_holds(
    verdict: HeldVerdict, fetch: tuple[FetchRun, Moves], monkeypatch: pytest.MonkeyPatch
) -> None:
    run, moves = fetch
    claw_tells(monkeypatch, run, Held(verdict, "", 0.045, 9.0))
    ended = asyncio.run(verifying.verify(run))
    is_held = verdict is HeldVerdict.HELD
    assert ended.outcome is (Outcome.DONE if is_held else Outcome.MISSED)
    assert moves.advances == [-0.06, 0.06][: 1 + is_held]
    assert moves.arms[-1].claw == CLOSED.claw
    assert run.memory.missed_from == (() if is_held else (HERE.heading + CLOSED.rotation,))
