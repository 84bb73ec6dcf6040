"""From a thing whose place is known to a tap on it in the newest picture."""

from tapreach.errors import InputError
from tapreach.geometry.finite import FloatArray
from tapreach.geometry.pixel import Pixel
from tapreach.tasks.target import Target
from tapreach.tasks.task import Tap, TaskContext


def pixel_of(context: TaskContext, point_in_world: FloatArray) -> Pixel | None:
    """Return where a point (3,) [m] falls with the base where it is now; None outside the picture."""
    camera = context.description.camera
    world_from_base = context.poses.newest()[1].to_rigid()
    camera_from_world = (world_from_base * camera.mount.base_from_camera()).inv()
    projection = camera.model().project(camera_from_world.apply(point_in_world)[None])
    if not projection.is_inside[0]:
        return None
    u, v = projection.pixels[0]
    return Pixel(float(u), float(v))


def tap_on(context: TaskContext, target: Target) -> Tap:
    """Return the tap on a target that has a position. Raises InputError when it is not in the picture."""
    frame = context.frames.newest
    pixel = pixel_of(context, target.point_in_world) if target.point_in_world is not None else None
    if frame is None or pixel is None:
        raise InputError(
            f"target {target.target_id} is not in the picture: turn so that it is, or tap it anew"
        )
    return Tap(frame.frame_id, pixel.u, pixel.v)
