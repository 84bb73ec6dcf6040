"""RTSP through PyAV: MJPEG passes untouched, everything else is decoded and encoded once as JPEG."""

from contextlib import suppress
from typing import Any

import av
import cv2
from av.container import InputContainer
from av.error import FFmpegError
from av.video.codeccontext import VideoCodecContext
from av.video.frame import VideoFrame

from tapreach.drivers.camera.jpeg import BrokenJpeg, whole_jpeg
from tapreach.drivers.camera.lag import Lag
from tapreach.drivers.camera.stream import OPEN_S, STALL_S, Picture
from tapreach.errors import DriverError
from tapreach.geometry.pixel import ImageSize
from tapreach.robot.camera_source import CameraSource
from tapreach.robot.clock import MS, SECOND, Clock

JPEG_QUALITY = 90
LATE_NS = 100 * MS
"""What is later than this is decoded, as what follows needs it, and not encoded: the newest wins."""
OPTIONS = {
    "rtsp_transport": "tcp",  # a lost packet costs a moment, not a picture in stripes
    "allowed_media_types": "video",
    "timeout": str(round(OPEN_S * 1e6)),  # of the socket [us]
    "flags": "low_delay",
    "analyzeduration": "1000",  # [us]; what is read while looking at the stream is late
    "fpsprobesize": "0",
}
FIRST_PICTURE_S = 10.0
"""What is coded by differences shows nothing before the next whole picture: cameras send one in 1 to 8 s."""


class RtspStream:
    """See Stream. A picture was taken `delay_ns` and its lag behind the stream's clock before it arrived.

    `interrupt` ends a wait only when its time is over (STALL_S): FFmpeg offers no other way.
    """

    def __init__(self, source: CameraSource, clock: Clock, delay_ns: int) -> None:
        self._source, self._clock, self._delay_ns = source, clock, delay_ns
        self._container: InputContainer | None = None
        self._pictures: Any = None
        self._lag = Lag()
        self._is_interrupted = False
        self.skipped = 0

    def open(self) -> None:
        """See Stream."""
        try:
            self._container = av.open(self._source.address, options=OPTIONS, timeout=(OPEN_S, STALL_S))
        except (FFmpegError, OSError, ValueError) as error:
            raise DriverError(f"{self._source.label} does not answer: {_said(error)}") from None
        if not self._container.streams.video:
            raise DriverError(f"{self._source.label} has no video stream")
        stream = self._container.streams.video[0]
        stream.thread_type = "SLICE"  # threads by frame would hold each picture back by several
        self._pictures = self._read_all(self._container, stream.codec_context)

    def read(self) -> Picture:
        """See Stream."""
        try:
            picture: Picture | None = next(self._pictures, None)
        except (FFmpegError, OSError) as error:
            raise DriverError(f"{self._source.label} broke off: {_said(error)}") from None
        if picture is None:
            raise DriverError(f"{self._source.label} has ended the stream")
        return picture

    def interrupt(self) -> None:
        """See Stream."""
        self._is_interrupted = True

    def close(self) -> None:
        """See Stream."""
        if self._container is not None:
            with suppress(FFmpegError, OSError):
                self._container.close()

    def _read_all(self, container: InputContainer, codec: VideoCodecContext) -> Any:
        passes = codec.name == "mjpeg"
        due_ns = self._clock.now_ns() + round(FIRST_PICTURE_S * SECOND)
        for packet in container.demux(video=0):
            now_ns = self._clock.now_ns()
            if self._is_interrupted:
                raise DriverError("closed")
            for picture in self._passed(packet, now_ns) if passes else self._decoded(codec, packet, now_ns):
                due_ns = now_ns + round(STALL_S * SECOND)
                yield picture
            if now_ns > due_ns:
                raise DriverError(f"{self._source.label} sends data, but no picture in time")

    def _passed(self, packet: Any, now_ns: int) -> list[Picture]:
        data = bytes(packet)
        if not data:
            return []
        try:
            jpeg, size = whole_jpeg(data)
        except BrokenJpeg:
            self.skipped += 1
            return []
        return [self._picture(packet.pts, packet.time_base, now_ns, size, jpeg)]

    def _decoded(self, codec: VideoCodecContext, packet: Any, now_ns: int) -> list[Picture]:
        try:
            frames = codec.decode(packet)
        except FFmpegError:
            self.skipped += 1
            return []
        return [picture for frame in frames if (picture := self._encoded(frame, now_ns)) is not None]

    def _encoded(self, frame: VideoFrame, now_ns: int) -> Picture | None:
        size = ImageSize(frame.width, frame.height)
        picture = self._picture(frame.pts, frame.time_base, now_ns, size, b"")
        if now_ns - self._delay_ns - picture.captured_ns > LATE_NS:
            return None
        bgr = frame.to_ndarray(format="bgr24")
        _, data = cv2.imencode(".jpg", bgr, [cv2.IMWRITE_JPEG_QUALITY, JPEG_QUALITY])
        return Picture(picture.captured_ns, now_ns, size, data.tobytes())

    def _picture(self, pts: int | None, time_base: Any, now_ns: int, size: ImageSize, jpeg: bytes) -> Picture:
        late_ns = 0 if pts is None or not time_base else self._lag.of(now_ns, round(pts * time_base * SECOND))
        return Picture(now_ns - self._delay_ns - late_ns, now_ns, size, jpeg)


def _said(error: Exception) -> str:
    return str(error).partition(": '")[0] or repr(error)
