"""How late is the camera? The robot turns to and fro on the floor, watches, and the robot file is told."""

import asyncio
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from math import hypot
from pathlib import Path

from tapreach.drivers.registry import make_robot
from tapreach.errors import DriverError, InputError
from tapreach.estimation.camera_delay import CameraDelay
from tapreach.robot.clock import MS, SECOND, Clock
from tapreach.robot.config import CameraSection, RobotDescription, load_robot
from tapreach.robot.interface import Robot
from tapreach.server.station import Station
from tapreach.server.task_desk import ComputeService
from tapreach.tasks.task import TaskState
from tapreach.tasks.teaching.file_changes import Changes, require_own_file
from tapreach.tasks.teaching.offer import offer_changes
from tapreach.tasks.teaching.person import Person

PATIENCE_NS = 10 * SECOND
PRESENCE_NS = 50 * MS
EARLY_MS = 5.0
"""Stamps may seem to lie so far ahead of their pictures; more is a fault that no delay makes up for."""


async def measure_delay(
    path: Path,
    person: Person,
    clock: Clock,
    make: Callable[[RobotDescription, Clock], Robot] = make_robot,
    compute: ComputeService | None = None,
) -> bool:
    """Measure it and write it into the robot file on the person's word; False where there is none.

    compute: a process of its own when left out. Raises InputError, ConfigError, DriverError and
    TeachingStopped; then the file is as it was.
    """
    require_own_file(path)
    description = load_robot(path)
    if description.camera.source is None:
        raise InputError(f"{description.name!r} has no [camera] source: there is no delay to measure")
    person.tell("The robot turns 6° left, 12° right and back, and watches. Ctrl-C stops it.")
    await person.ask("Does it stand on the floor, free all around, and see what stands still?", ("yes",))
    station = Station(make(description, clock), clock, Path("captures"), compute)
    async with _operated(station, clock) as session_id:
        ended = await station.tasks.measure_delay(session_id)
    found = station.camera_delay.known
    if ended is None or ended.state is not TaskState.DONE or found is None:
        raise DriverError(ended.message if ended else "it was not measured")
    person.tell(f"Beyond what the robot file says, {ended.message}.")
    return await offer_changes(person, path, changes_of(description.camera, found))


def changes_of(camera: CameraSection, found: CameraDelay) -> Changes:
    """Return what to write: found is what is left beyond the file's delay_ms. Raises InputError."""
    delay_ms = camera.delay_ms + 1000.0 * found.delay
    if delay_ms < -EARLY_MS:
        raise InputError(f"pictures seem to be taken {-delay_ms:.0f} ms after their stamps: measure again")
    sigma_ms = 1000.0 * hypot(found.sigma, found.scatter)
    return {
        ("camera", "delay_ms"): round(max(0.0, delay_ms), 1),
        ("camera", "timing_sigma_ms"): round(sigma_ms, 1),
    }


@asynccontextmanager
async def _operated(station: Station, clock: Clock) -> AsyncIterator[int]:
    """Start it, be its operator, and stop it."""
    session_id = station.guests.arrive()
    presence: asyncio.Task[None] | None = None
    try:
        await station.start()
        station.lease.request(session_id)
        presence = asyncio.create_task(_stay(station, clock))
        await _until_it_sees(station, clock)
        yield session_id
    finally:
        if presence is not None:
            presence.cancel()
        await station.stop()


async def _stay(station: Station, clock: Clock) -> None:
    while True:
        station.deadman.heard()
        await clock.sleep_until(clock.now_ns() + PRESENCE_NS)


async def _until_it_sees(station: Station, clock: Clock) -> None:
    """Wait for board and camera, and half a second of odometry before the turn. Raises DriverError."""
    end_ns = clock.now_ns() + PATIENCE_NS
    while station.frames.newest is None or not station.robot.health.is_running or not len(station.poses):
        if clock.now_ns() >= end_ns:
            reason = station.robot.health.reason or "no picture has come"
            raise DriverError(f"{reason}; tapreach doctor without --measure says more")
        await clock.sleep_until(clock.now_ns() + PRESENCE_NS)
    await clock.sleep_until(clock.now_ns() + SECOND // 2)
