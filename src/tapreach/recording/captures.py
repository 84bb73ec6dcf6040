"""Captured frames on disk: a JPEG and a JSON of the same name, written whole or not at all."""

import json
import os
import re
from contextlib import suppress
from dataclasses import asdict, dataclass
from datetime import datetime
from math import degrees
from pathlib import Path
from typing import Any

from tapreach.errors import InputError, TapreachError
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.robot.config import CameraSection
from tapreach.robot.messages import ArmPose, Frame

_ID = re.compile(r"\d{8}-\d{6}-f\d{1,10}")


class CaptureFailed(TapreachError):
    """A capture could not be written, read or deleted; says why."""


@dataclass(frozen=True, slots=True)
class CaptureContext:
    """What is known about the moment of a frame; None where it is not."""

    taken_at: datetime
    world_from_base: PlanarPose | None
    arm: ArmPose | None
    camera: CameraSection
    robot: str


class CaptureFolder:
    """A folder of captures. Blocking: call it from a thread. Ids look like 20260131-235959-f123."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder

    def save(self, frame: Frame, context: CaptureContext) -> str:
        """Write a frame and return its id. Raises CaptureFailed (disk full, no rights)."""
        capture_id = f"{context.taken_at:%Y%m%d-%H%M%S}-f{frame.frame_id}"
        facts = json.dumps(_facts(capture_id, frame, context), indent=2).encode()
        try:
            self._folder.mkdir(parents=True, exist_ok=True)
            _write_whole(self._folder / f"{capture_id}.jpg", frame.jpeg)
            _write_whole(self._folder / f"{capture_id}.json", facts)
        except OSError as error:
            with suppress(OSError):
                (self._folder / f"{capture_id}.jpg").unlink()
            raise CaptureFailed(f"capture not stored in {self._folder}: {error.strerror}") from error
        return capture_id

    def listed(self) -> list[dict[str, Any]]:
        """Return the facts of all captures, newest first. A capture that cannot be read is left out."""
        found = []
        for path in sorted(self._folder.glob("*.json"), reverse=True):
            with suppress(OSError, ValueError):
                if _ID.fullmatch(path.stem) and path.with_suffix(".jpg").is_file():
                    found.append(json.loads(path.read_bytes()))
        return found

    def picture(self, capture_id: str) -> bytes:
        """Return the JPEG. Raises InputError for an impossible id, CaptureFailed where there is none."""
        return self._read(capture_id, ".jpg")

    def facts(self, capture_id: str) -> bytes:
        """Return the JSON. Raises as `picture`."""
        return self._read(capture_id, ".json")

    def delete(self, capture_id: str) -> None:
        """Delete both files. Raises as `picture`."""
        try:
            # Facts first: without them the capture is no longer listed, whatever happens next.
            self._path(capture_id, ".json").unlink()
            self._path(capture_id, ".jpg").unlink(missing_ok=True)
        except OSError as error:
            raise CaptureFailed(f"capture {capture_id} not deleted: {error.strerror}") from error

    def _read(self, capture_id: str, suffix: str) -> bytes:
        try:
            return self._path(capture_id, suffix).read_bytes()
        except OSError as error:
            raise CaptureFailed(f"there is no capture {capture_id}: {error.strerror}") from error

    def _path(self, capture_id: str, suffix: str) -> Path:
        # The pattern has no dot and no slash, so an id cannot lead out of the folder.
        if not _ID.fullmatch(capture_id):
            raise InputError(f"capture id {capture_id!r} must look like 20260131-235959-f123")
        return self._folder / f"{capture_id}{suffix}"


def _write_whole(path: Path, content: bytes) -> None:
    """Write to a neighbour and rename, so that nobody ever sees half a file."""
    unfinished = path.with_name(f".{path.name}.{os.getpid()}.tmp")
    try:
        with unfinished.open("wb") as file:
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
        unfinished.replace(path)
    finally:
        unfinished.unlink(missing_ok=True)


def _facts(capture_id: str, frame: Frame, context: CaptureContext) -> dict[str, Any]:
    base, arm = context.world_from_base, context.arm
    return {
        "id": capture_id,
        "taken_at": context.taken_at.isoformat(),
        "robot": context.robot,
        "frame_id": frame.frame_id,
        "captured_ns": frame.captured_ns,
        "width": frame.size.width,
        "height": frame.size.height,
        "world_from_base": None
        if base is None
        else {"x": base.x, "y": base.y, "heading_deg": degrees(base.heading)},
        "arm": None if arm is None else asdict(arm),
        "camera": context.camera.model_dump(),
    }
