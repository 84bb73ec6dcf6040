"""How far a JPEG reaches and how large its picture is, read from its markers (ITU-T T.81, annex B)."""

from tapreach.geometry.pixel import ImageSize

START = b"\xff\xd8"
_END, _SCAN = 0xD9, 0xDA
_FRAMES = frozenset(range(0xC0, 0xD0)) - {0xC4, 0xC8, 0xCC}
_STUFFED_OR_RESTART = frozenset({0x00, *range(0xD0, 0xD8)})


class BrokenJpeg(ValueError):
    """These bytes are no JPEG; the message says why."""


class JpegWalk:
    """Walks through the markers of one JPEG as its bytes arrive; no byte is looked at twice.

    Only the frame is looked at: pixels that are coded wrongly are found where somebody decodes them.
    """

    def __init__(self) -> None:
        self._at = 0
        self._in_scan = False
        self.size: ImageSize | None = None
        """Known from the frame header on."""

    def advance(self, data: bytes | bytearray) -> int | None:
        """Take all bytes that are there, from the first; return the JPEG's length, or None for more.

        Raises BrokenJpeg.
        """
        if self._at == 0:
            if len(data) < 2:
                return None
            if bytes(data[:2]) != START:
                raise BrokenJpeg("does not begin as a JPEG")
            self._at = 2
        while self._step(data):
            if self._at < 0:
                return -self._at
        return None

    def _step(self, data: bytes | bytearray) -> bool:
        """Go past one marker; False when its bytes are not all there. The end is left as minus the length."""
        if self._in_scan and not self._skip_scan(data):
            return False
        at = self._at
        if at + 2 > len(data):
            return False
        if data[at] != 0xFF:
            raise BrokenJpeg(f"byte {at} should begin a marker")
        marker = data[at + 1]
        if marker == 0xFF:  # fill byte
            self._at += 1
            return True
        if marker == _END:
            if self.size is None:
                raise BrokenJpeg("ends without a picture")
            self._at = -(at + 2)
            return True
        return self._segment(data, at, marker)

    def _segment(self, data: bytes | bytearray, at: int, marker: int) -> bool:
        if at + 9 > len(data):
            return False
        length = data[at + 2] << 8 | data[at + 3]
        if length < 2 or marker < 0xC0 or 0xD0 <= marker <= 0xD8:
            raise BrokenJpeg(f"marker {marker:#04x} of length {length} at byte {at}")
        if marker in _FRAMES:
            width, height = data[at + 7] << 8 | data[at + 8], data[at + 5] << 8 | data[at + 6]
            if width == 0 or height == 0:
                raise BrokenJpeg(f"a picture of {width} x {height}")
            self.size = ImageSize(width, height)
        elif marker == _SCAN:
            self._in_scan = True
        self._at = at + 2 + length
        return True

    def _skip_scan(self, data: bytes | bytearray) -> bool:
        while 0 <= (at := data.find(b"\xff", self._at)) < len(data) - 1:
            if data[at + 1] not in _STUFFED_OR_RESTART:
                self._at, self._in_scan = at, False
                return True
            self._at = at + 2
        self._at = at if at >= 0 else max(self._at, len(data))
        return False


def whole_jpeg(data: bytes) -> tuple[bytes, ImageSize]:
    """Return the JPEG that `data` begins with, without what a camera pads it with, and its size.

    Raises BrokenJpeg where it is not whole.
    """
    walk = JpegWalk()
    length = walk.advance(data)
    if length is None or walk.size is None:
        raise BrokenJpeg(f"ends after {len(data)} bytes, before the picture does")
    return data[:length] if length < len(data) else data, walk.size
