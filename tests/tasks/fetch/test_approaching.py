"""Driving up: what is seen but known badly is looked at from a step back, what is gone is let go."""

import asyncio
from typing import Any

import pytest

from tapreach.geometry.planar_motion import PlanarStep
from tapreach.tasks.fetch import approaching
from tapreach.tasks.fetch.approach import Leg
from tapreach.tasks.fetch.approaching import BACK, GONE_SD, LOOK_ANEW_SD, MOST_LOOKS, last_look
from tapreach.tasks.fetch.looking_again import loss_of, still_followed
from tapreach.tasks.fetch.preview import preview
from tapreach.tasks.fetch.run import Ended, FetchRun
from tapreach.tasks.fetch.states import Outcome
from tasks.fetch.looks import HERE, RED, Followed, Located, run_after_look
from tasks.fetch.worlds import ROBOT, thing_at


class Driven:
    """Legs that were driven, and how often the thing was located anew."""

    def __init__(self) -> None:
        self.legs: list[Leg] = []
        self.located = 0


@pytest.fixture
def driven(monkeypatch: pytest.MonkeyPatch) -> Driven:
    done = Driven()

    async def drive(run: FetchRun, leg: Leg) -> str:
        done.legs.append(leg)
        return ""

    async def nothing(*_: Any) -> None:
        return None

    async def anew(run: FetchRun, steps_back: bool = False) -> Ended:
        done.located += 1
        return Ended(Outcome.UNSURE, "located anew")

    async def judged(*_: Any, **__: Any) -> Any:
        return preview(thing_at(0.6, 0.03), [], HERE, ROBOT)

    for name, stand_in in {"drive": drive, "measure": nothing, "_anew": anew, "previewed": judged}.items():
        monkeypatch.setattr(approaching, name, stand_in)
    return done


def known_to(monkeypatch: pytest.MonkeyPatch, sd: float, behind: float = 0.0) -> None:
    monkeypatch.setattr(approaching, "_place_sd", lambda run: sd)
    monkeypatch.setattr(approaching, "way_behind", lambda poses: behind)


def test_place_known_badly_is_looked_at_from_a_step_back(
    driven: Driven, monkeypatch: pytest.MonkeyPatch
) -> None:
    run = run_after_look((RED, RED, RED))
    known_to(monkeypatch, 2.0 * LOOK_ANEW_SD, behind=0.5)
    for _ in range(MOST_LOOKS + 1):
        ended = asyncio.run(last_look(run))
    assert [leg.step for leg in driven.legs] == (MOST_LOOKS - 1) * [PlanarStep(0.0, -BACK)]
    assert driven.located == 0 and ended.outcome is not Outcome.UNSURE


@pytest.mark.parametrize("views", [1, 3])
def test_without_room_behind_it_is_located_anew_unless_all_was_seen_from_here(
    views: int, driven: Driven, monkeypatch: pytest.MonkeyPatch
) -> None:
    run = run_after_look((RED, RED, RED))
    newest = Located(Followed(list(run.locating.follower.sightings[-views:])))  # type: ignore[union-attr]
    run.locating = newest  # type: ignore[assignment]
    known_to(monkeypatch, 2.0 * LOOK_ANEW_SD)
    asyncio.run(last_look(run))
    assert driven.located == int(views > 1) and not driven.legs


def test_what_is_gone_is_not_driven_after(driven: Driven, monkeypatch: pytest.MonkeyPatch) -> None:
    run = run_after_look((RED, RED, RED))
    run.locating.follower.loss = "it is hidden"  # type: ignore[union-attr]

    async def not_found(*_: Any, **__: Any) -> None:
        return None

    async def far_away(*_: Any, **__: Any) -> Any:
        return preview(thing_at(2.0, 0.03), [], HERE, ROBOT)

    monkeypatch.setattr(approaching, "_anew", not_found)
    monkeypatch.setattr(approaching, "previewed", far_away)
    known_to(monkeypatch, 2.0 * GONE_SD)
    ended = asyncio.run(approaching.approach(run))
    assert ended.outcome is Outcome.LOST and "it is hidden" in ended.why
    assert len(driven.legs) == 1


def test_what_was_followed_here_but_not_confirmed_is_lost() -> None:
    """A check believes only in sightings from far away: the place is not seen from here."""
    run = run_after_look((RED, RED, RED))
    assert loss_of(run) == "" and still_followed(run) is not None
    run.context.poses.add(9, HERE.after(PlanarStep(0.3, 0.2)))
    assert "not surely what was tapped" in loss_of(run)
    assert still_followed(run) is None
