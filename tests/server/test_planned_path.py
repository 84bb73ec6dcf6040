"""The move of a task on the page and in the picture: its way and what it should bring, until it is over."""

import json
from pathlib import Path

import numpy as np
import pytest

from tapreach.geometry.planar_motion import PlanarPose, PlanarStep
from tapreach.robot.config import load_robot
from tapreach.server.hub import Hub
from tapreach.server.markers import MarkerProjection
from tapreach.server.outbox import Outbox
from tapreach.server.planned_path import PlannedPath
from tapreach.tasks.planned_move import PlannedMove

ROBOT = load_robot(Path(__file__).resolve().parents[2] / "robots" / "fake.toml")
HERE = PlanarPose(0.3, -0.2, 0.4)
MOVE = PlannedMove(HERE, PlanarStep(0.2, 0.5), 0.021, 0.014)


class Heard(Outbox):
    """Keeps what is put into it."""

    def __init__(self) -> None:
        super().__init__()
        self.messages: list[dict] = []

    def put(self, key: str, text: str) -> None:
        self.messages.append(json.loads(text))


def shown() -> tuple[PlannedPath, Hub, Heard]:
    hub, page = Hub(), Heard()
    hub.join(page)
    path = PlannedPath(hub, ROBOT)
    path.show(MOVE)
    return path, hub, page


def test_page_is_told_way_body_and_expectation():
    _, _, page = shown()
    (message,) = page.messages
    assert message["type"] == "move"
    assert (message["expected_sd"], message["expected_relative_sd"]) == (0.021, 0.014)
    left, right = np.array(message["tracks_in_world"])
    middle = (left + right) / 2.0
    end = HERE.after(MOVE.step)
    assert middle[0] == pytest.approx((HERE.x, HERE.y))
    assert middle[-1] == pytest.approx((end.x, end.y))
    assert len(message["body_in_world"]) == 4
    assert "turning 11° left" in message["words"]


def test_move_that_is_over_is_gone_from_page_and_picture_and_newcomers_hear_nothing():
    path, hub, page = shown()
    path.show(None)
    assert page.messages[-1]["tracks_in_world"] == [] and page.messages[-1]["expected_sd"] is None
    assert path.lines_in_world == []
    path.show(None)
    assert len(page.messages) == 2
    newcomer = Heard()
    hub.join(newcomer)
    assert newcomer.messages == []


def test_newcomer_hears_of_the_move_that_is_being_made():
    _, hub, page = shown()
    newcomer = Heard()
    hub.join(newcomer)
    assert newcomer.messages == page.messages


def test_path_lies_on_the_floor_in_the_picture():
    path, _, _ = shown()
    meta = json.loads(MarkerProjection(ROBOT.camera).meta(HERE, [], path.lines_in_world))
    left, right, body = meta["path"]
    camera_from_world = (HERE.to_rigid() * ROBOT.camera.mount.base_from_camera()).inv()
    expected = ROBOT.camera.model().project(camera_from_world.apply(path.lines_in_world[0])[-1:]).pixels[0]
    assert left[-1] == pytest.approx(expected, abs=0.06)
    assert left[-1][0] < right[-1][0]
    assert len(body) == 5 and body[0] == body[-1]


def test_what_is_under_or_behind_the_camera_is_left_out():
    path, _, _ = shown()
    there = HERE.after(PlanarStep(0.2, 0.45))
    meta = json.loads(MarkerProjection(ROBOT.camera).meta(there, [], path.lines_in_world))
    assert len(meta["path"][0]) < 7
    assert np.isfinite(np.concatenate([np.array(line).reshape(-1, 2) for line in meta["path"]])).all()
    assert "path" not in json.loads(MarkerProjection(ROBOT.camera).meta(there, []))
