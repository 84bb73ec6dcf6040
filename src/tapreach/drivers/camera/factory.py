"""The camera of a robot file."""

from collections.abc import Callable

from tapreach.drivers.camera.http_stream import MjpegStream
from tapreach.drivers.camera.stream import Hold, Stream
from tapreach.drivers.camera.threaded import ThreadedCamera
from tapreach.drivers.camera.v4l2_stream import V4l2Stream
from tapreach.errors import ConfigError
from tapreach.geometry.pixel import ImageSize
from tapreach.robot.camera_source import KNOWN_SOURCES, CameraSource, SourceKind, parse_source
from tapreach.robot.clock import MS, Clock
from tapreach.robot.config import CameraSection


def make_camera(section: CameraSection, clock: Clock) -> ThreadedCamera:
    """Return the camera that `section.source` names, not yet opened.

    Raises ConfigError where there is no source, InputError where it names no known kind.
    """
    if section.source is None:
        raise ConfigError(f"[camera] needs a source: {KNOWN_SOURCES}")
    hold = Hold()
    make_stream = _stream_maker(parse_source(section.source), section, clock, hold)
    return ThreadedCamera(make_stream, ImageSize(section.width, section.height), clock, hold)


def _stream_maker(
    source: CameraSource, section: CameraSection, clock: Clock, hold: Hold
) -> Callable[[], Stream]:
    delay_ns = round(section.delay_ms * MS)
    size = ImageSize(section.width, section.height)
    if source.kind is SourceKind.V4L2:
        keeps = section.keeps_settings
        return lambda: V4l2Stream(
            source.address, clock, delay_ns, size, section.rate_hz, hold, keeps_settings=keeps
        )
    if source.kind is SourceKind.HTTP:
        return lambda: MjpegStream(source, clock, delay_ns)
    return lambda: _rtsp_stream(source, clock, delay_ns)


def _rtsp_stream(source: CameraSource, clock: Clock, delay_ns: int) -> Stream:
    # FFmpeg is loaded where it is needed only: on a small computer that takes most of a second.
    from tapreach.drivers.camera.rtsp_stream import RtspStream

    return RtspStream(source, clock, delay_ns)
