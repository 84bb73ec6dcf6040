"""Captures: whole or not at all, found again, and no way out of the folder."""

import errno
import json
from datetime import UTC, datetime
from pathlib import Path

import pytest

from tapreach.errors import InputError
from tapreach.geometry.pixel import ImageSize
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.recording.captures import CaptureContext, CaptureFailed, CaptureFolder
from tapreach.robot.config import CameraSection, MountSection
from tapreach.robot.messages import ArmPose, Frame

FRAME = Frame(12, 5_000, 6_000, ImageSize(640, 480), b"\xff\xd8 a picture \xff\xd9")
CONTEXT = CaptureContext(
    taken_at=datetime(2026, 1, 31, 23, 59, 58, tzinfo=UTC),
    world_from_base=PlanarPose(1.0, -2.0, 0.5),
    arm=ArmPose(0.1, 0.2, 0.3, 0.04),
    camera=CameraSection(fx=500.0, mount=MountSection(forward=0.1, up=0.15)),
    robot="rover",
)
ID = "20260131-235958-f12"


@pytest.fixture
def folder(tmp_path: Path) -> CaptureFolder:
    return CaptureFolder(tmp_path / "captures")


def test_constructor_touches_nothing(tmp_path):
    CaptureFolder(tmp_path / "captures")
    assert list(tmp_path.iterdir()) == []


def test_what_was_saved_is_read_back(folder):
    assert folder.save(FRAME, CONTEXT) == ID
    assert folder.picture(ID) == FRAME.jpeg
    facts = json.loads(folder.facts(ID))
    assert facts["id"] == ID
    assert facts["captured_ns"] == 5_000
    assert facts["taken_at"] == "2026-01-31T23:59:58+00:00"
    assert facts["world_from_base"]["y"] == -2.0
    assert facts["arm"]["claw"] == 0.04
    assert facts["camera"]["fx"] == 500.0
    assert folder.listed() == [facts]


def test_what_is_not_known_is_null(folder):
    unknown = CaptureContext(CONTEXT.taken_at, None, None, CONTEXT.camera, "rover")
    facts = json.loads(folder.facts(folder.save(FRAME, unknown)))
    assert (facts["world_from_base"], facts["arm"]) == (None, None)


def test_newest_capture_is_listed_first(folder):
    for second in (10, 30, 20):
        taken = CONTEXT.taken_at.replace(second=second)
        context = CaptureContext(taken, None, None, CONTEXT.camera, "rover")
        folder.save(FRAME, context)
    assert [facts["taken_at"][17:19] for facts in folder.listed()] == ["30", "20", "10"]


def test_deleted_capture_is_gone(folder):
    folder.save(FRAME, CONTEXT)
    folder.delete(ID)
    assert folder.listed() == []
    with pytest.raises(CaptureFailed, match=ID):
        folder.picture(ID)
    with pytest.raises(CaptureFailed, match=ID):
        folder.delete(ID)


@pytest.mark.parametrize(
    "capture_id",
    ["..", "../secret", "../../etc/passwd", "/etc/passwd", "", ID + "/x", ID + "\n", ID + "\0", "a" * 5000],
)
def test_id_that_leads_out_of_the_folder_is_refused(folder, tmp_path, capture_id):
    (tmp_path / "secret.jpg").write_bytes(b"secret")
    (tmp_path / "secret.json").write_bytes(b"{}")
    for use in (folder.picture, folder.facts, folder.delete):
        with pytest.raises(InputError, match="must look like"):
            use(capture_id)
    assert (tmp_path / "secret.json").exists()


@pytest.mark.parametrize("broken_after", [0, 1])
def test_full_disk_leaves_nothing_and_says_why(folder, tmp_path, monkeypatch, broken_after):
    writes = []

    def full(path: Path, target: Path) -> Path:
        writes.append(target)
        if len(writes) > broken_after:
            raise OSError(errno.ENOSPC, "No space left on device")
        return plain(path, target)

    plain = Path.replace
    monkeypatch.setattr(Path, "replace", full)
    with pytest.raises(CaptureFailed, match="No space left on device"):
        folder.save(FRAME, CONTEXT)
    assert list((tmp_path / "captures").iterdir()) == []


def test_folder_that_cannot_be_made_is_named(tmp_path):
    (tmp_path / "captures").write_text("a file is in the way")
    with pytest.raises(CaptureFailed, match="captures"):
        CaptureFolder(tmp_path / "captures").save(FRAME, CONTEXT)


def test_broken_and_foreign_files_are_left_out_of_the_list(folder, tmp_path):
    folder.save(FRAME, CONTEXT)
    captures = tmp_path / "captures"
    (captures / "20260101-000000-f1.json").write_text("{ half")
    (captures / "20260101-000000-f1.jpg").write_bytes(b"")
    (captures / "notes.json").write_text("{}")
    (captures / "20260101-000000-f2.json").write_text("{}")
    assert [facts["id"] for facts in folder.listed()] == [ID]
