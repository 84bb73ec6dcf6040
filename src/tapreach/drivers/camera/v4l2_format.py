"""What a V4L2 camera is asked for: pictures it codes itself as JPEG, else raw ones that are coded here."""

import errno
from contextlib import suppress

import cv2
import numpy as np

from tapreach.drivers.camera.jpeg import BrokenJpeg, whole_jpeg
from tapreach.drivers.camera.v4l2_abi import (
    CAN_CAPTURE,
    CAN_STREAM,
    CAPTURE,
    ENUM_FMT,
    HAS_DEVICE_CAPS,
    QUERYCAP,
    S_FMT,
    S_PARM,
    Capability,
    Format,
    FormatDescription,
    StreamParameters,
    fourcc,
    fourcc_name,
)
from tapreach.drivers.camera.v4l2_device import Device
from tapreach.errors import DriverError
from tapreach.geometry.pixel import ImageSize

JPEG_FORMATS, RAW_FORMATS = ("MJPG", "JPEG"), ("YUYV",)
JPEG_QUALITY = 90


def choose_format(device: Device, size: ImageSize, rate_hz: float) -> str:
    """Set the best format for pictures of `size` and return its name. Raises DriverError or OSError."""
    _require_camera(device)
    offered = offered_formats(device)
    chosen = next((name for name in (*JPEG_FORMATS, *RAW_FORMATS) if name in offered), None)
    if chosen is None:
        known = ", ".join((*JPEG_FORMATS, *RAW_FORMATS))
        raise DriverError(f"the camera offers {', '.join(offered) or 'no format'}; known here are {known}")
    wish = Format(type=CAPTURE, width=size.width, height=size.height, pixelformat=fourcc(chosen))
    device.ioctl(S_FMT, wish)
    if (wish.width, wish.height, wish.pixelformat) != (size.width, size.height, fourcc(chosen)):
        raise DriverError(
            f"asked for {chosen} {size.width} x {size.height} the camera gives "
            f"{fourcc_name(wish.pixelformat)} {wish.width} x {wish.height}: set the robot file's width and "
            "height, and fx with them, to a size that it has"
        )
    rate = StreamParameters(type=CAPTURE, numerator=1000, denominator=round(1000 * rate_hz))
    with suppress(OSError):  # not every camera can be asked
        device.ioctl(S_PARM, rate)
    return chosen


def offered_formats(device: Device) -> list[str]:
    """Return the names of the pixel formats that the camera has, in its order."""
    names: list[str] = []
    for index in range(64):
        description = FormatDescription(index=index, type=CAPTURE)
        try:
            device.ioctl(ENUM_FMT, description)
        except OSError as error:
            if error.errno != errno.EINVAL:  # EINVAL: that was the last one
                raise
            break
        names.append(fourcc_name(description.pixelformat))
    return names


def as_jpeg(data: bytes, name: str, size: ImageSize) -> tuple[bytes, ImageSize]:
    """Return a buffer's picture as JPEG, untouched where it is one. Raises BrokenJpeg."""
    if name in JPEG_FORMATS:
        return whole_jpeg(data)
    expected = size.width * size.height * 2
    if len(data) < expected:
        raise BrokenJpeg(f"{len(data)} bytes, not {expected}")
    yuyv = np.frombuffer(data, np.uint8, expected).reshape(size.height, size.width, 2)
    bgr = cv2.cvtColor(yuyv, cv2.COLOR_YUV2BGR_YUYV)
    _, coded = cv2.imencode(".jpg", bgr, [cv2.IMWRITE_JPEG_QUALITY, JPEG_QUALITY])
    return coded.tobytes(), size


def _require_camera(device: Device) -> None:
    capability = Capability()
    device.ioctl(QUERYCAP, capability)
    has_own = capability.capabilities & HAS_DEVICE_CAPS
    flags = capability.device_caps if has_own else capability.capabilities
    if not flags & CAN_CAPTURE or not flags & CAN_STREAM:
        card = capability.card.decode("utf-8", "replace")
        raise DriverError(
            f"{card!r} gives no pictures here: a camera often has a second device file; try /dev/video0"
        )
