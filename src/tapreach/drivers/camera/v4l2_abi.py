"""The part of Linux' video interface that is used here: linux/videodev2.h on 64-bit machines."""

import ctypes
from ctypes import Structure, c_char, c_int32, c_int64, c_uint8, c_uint32, c_uint64

CAPTURE, MMAP, ANY_FIELD = 1, 1, 0
CAN_CAPTURE, CAN_STREAM, HAS_DEVICE_CAPS = 0x1, 0x04000000, 0x80000000
BUFFER_ERROR, STAMP_MASK, STAMP_MONOTONIC = 0x40, 0xE000, 0x2000
CONTROL_DISABLED, CONTROL_READ_ONLY = 0x1, 0x4


class Capability(Structure):
    """struct v4l2_capability."""

    _fields_ = (
        ("driver", c_char * 16), ("card", c_char * 32), ("bus_info", c_char * 32), ("version", c_uint32),
        ("capabilities", c_uint32), ("device_caps", c_uint32), ("reserved", c_uint32 * 3),
    )  # fmt: skip


class FormatDescription(Structure):
    """struct v4l2_fmtdesc."""

    _fields_ = (
        ("index", c_uint32), ("type", c_uint32), ("flags", c_uint32), ("description", c_char * 32),
        ("pixelformat", c_uint32), ("mbus_code", c_uint32), ("reserved", c_uint32 * 3),
    )  # fmt: skip


class Format(Structure):
    """struct v4l2_format with its union taken as v4l2_pix_format."""

    _fields_ = (
        ("type", c_uint32), ("_alignment", c_uint32), ("width", c_uint32), ("height", c_uint32),
        ("pixelformat", c_uint32), ("field", c_uint32), ("bytesperline", c_uint32), ("sizeimage", c_uint32),
        ("_rest", c_uint8 * 176),
    )  # fmt: skip


class StreamParameters(Structure):
    """struct v4l2_streamparm with its union taken as v4l2_captureparm."""

    _fields_ = (
        ("type", c_uint32), ("capability", c_uint32), ("capturemode", c_uint32), ("numerator", c_uint32),
        ("denominator", c_uint32), ("_rest", c_uint8 * 184),
    )  # fmt: skip


class RequestBuffers(Structure):
    """struct v4l2_requestbuffers."""

    _fields_ = (
        ("count", c_uint32), ("type", c_uint32), ("memory", c_uint32), ("capabilities", c_uint32),
        ("flags", c_uint8), ("reserved", c_uint8 * 3),
    )  # fmt: skip


class Buffer(Structure):
    """struct v4l2_buffer."""

    _fields_ = (
        ("index", c_uint32), ("type", c_uint32), ("bytesused", c_uint32), ("flags", c_uint32),
        ("field", c_uint32), ("seconds", c_int64), ("microseconds", c_int64), ("timecode", c_uint32 * 4),
        ("sequence", c_uint32), ("memory", c_uint32), ("offset", c_uint64), ("length", c_uint32),
        ("reserved2", c_uint32), ("request_fd", c_uint32),
    )  # fmt: skip


class BufferType(Structure):
    """The int that STREAMON and STREAMOFF take."""

    _fields_ = (("type", c_uint32),)


class Control(Structure):
    """struct v4l2_control."""

    _fields_ = (("id", c_uint32), ("value", c_int32))


class ControlDescription(Structure):
    """struct v4l2_queryctrl."""

    _fields_ = (
        ("id", c_uint32), ("type", c_uint32), ("name", c_char * 32), ("minimum", c_int32),
        ("maximum", c_int32), ("step", c_int32), ("default_value", c_int32), ("flags", c_uint32),
        ("reserved", c_uint32 * 2),
    )  # fmt: skip


_WRITE, _READ = 1, 2


def _request(direction: int, number: int, structure: type[Structure]) -> int:
    return direction << 30 | ctypes.sizeof(structure) << 16 | ord("V") << 8 | number


QUERYCAP = _request(_READ, 0, Capability)
ENUM_FMT = _request(_READ | _WRITE, 2, FormatDescription)
S_FMT = _request(_READ | _WRITE, 5, Format)
REQBUFS = _request(_READ | _WRITE, 8, RequestBuffers)
QUERYBUF = _request(_READ | _WRITE, 9, Buffer)
QBUF = _request(_READ | _WRITE, 15, Buffer)
DQBUF = _request(_READ | _WRITE, 17, Buffer)
STREAMON = _request(_WRITE, 18, BufferType)
STREAMOFF = _request(_WRITE, 19, BufferType)
S_PARM = _request(_READ | _WRITE, 22, StreamParameters)
G_CTRL = _request(_READ | _WRITE, 27, Control)
S_CTRL = _request(_READ | _WRITE, 28, Control)
QUERYCTRL = _request(_READ | _WRITE, 36, ControlDescription)


def fourcc(name: str) -> int:
    """Return a pixel format's number, as of 'MJPG'."""
    return int.from_bytes(name.encode("ascii"), "little")


def fourcc_name(number: int) -> str:
    """Return a pixel format's name."""
    return number.to_bytes(4, "little").decode("latin-1").rstrip()
