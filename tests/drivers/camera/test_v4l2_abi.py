"""The structures and request numbers are those of linux/videodev2.h on 64-bit machines."""

import ctypes
import shutil
import subprocess
from pathlib import Path

import pytest

from tapreach.drivers.camera import v4l2_abi as abi

RECORDED = {
    "QUERYCAP": 0x80685600, "ENUM_FMT": 0xC0405602, "S_FMT": 0xC0D05605, "REQBUFS": 0xC0145608,
    "QUERYBUF": 0xC0585609, "QBUF": 0xC058560F, "DQBUF": 0xC0585611, "STREAMON": 0x40045612,
    "STREAMOFF": 0x40045613, "S_PARM": 0xC0CC5616, "G_CTRL": 0xC008561B, "S_CTRL": 0xC008561C,
    "QUERYCTRL": 0xC0445624,
}  # fmt: skip
PLACES = {
    "v4l2_capability.device_caps": abi.Capability.device_caps,
    "v4l2_fmtdesc.pixelformat": abi.FormatDescription.pixelformat,
    "v4l2_format.fmt.pix.width": abi.Format.width,
    "v4l2_format.fmt.pix.pixelformat": abi.Format.pixelformat,
    "v4l2_format.fmt.pix.sizeimage": abi.Format.sizeimage,
    "v4l2_streamparm.parm.capture.timeperframe.numerator": abi.StreamParameters.numerator,
    "v4l2_streamparm.parm.capture.timeperframe.denominator": abi.StreamParameters.denominator,
    "v4l2_requestbuffers.memory": abi.RequestBuffers.memory,
    "v4l2_buffer.bytesused": abi.Buffer.bytesused,
    "v4l2_buffer.flags": abi.Buffer.flags,
    "v4l2_buffer.timestamp.tv_sec": abi.Buffer.seconds,
    "v4l2_buffer.timestamp.tv_usec": abi.Buffer.microseconds,
    "v4l2_buffer.sequence": abi.Buffer.sequence,
    "v4l2_buffer.memory": abi.Buffer.memory,
    "v4l2_buffer.m.offset": abi.Buffer.offset,
    "v4l2_buffer.length": abi.Buffer.length,
    "v4l2_control.value": abi.Control.value,
    "v4l2_queryctrl.flags": abi.ControlDescription.flags,
}
VALUES = {
    "V4L2_CAP_VIDEO_CAPTURE": abi.CAN_CAPTURE, "V4L2_CAP_STREAMING": abi.CAN_STREAM,
    "V4L2_CAP_DEVICE_CAPS": abi.HAS_DEVICE_CAPS, "V4L2_BUF_TYPE_VIDEO_CAPTURE": abi.CAPTURE,
    "V4L2_MEMORY_MMAP": abi.MMAP, "V4L2_BUF_FLAG_ERROR": abi.BUFFER_ERROR,
    "V4L2_BUF_FLAG_TIMESTAMP_MASK": abi.STAMP_MASK,
    "V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC": abi.STAMP_MONOTONIC, "V4L2_PIX_FMT_MJPEG": abi.fourcc("MJPG"),
    "V4L2_PIX_FMT_YUYV": abi.fourcc("YUYV"), "V4L2_CTRL_FLAG_DISABLED": abi.CONTROL_DISABLED,
    "V4L2_CTRL_FLAG_READ_ONLY": abi.CONTROL_READ_ONLY, "V4L2_CID_EXPOSURE_AUTO": 0x009A0901,
    "V4L2_CID_EXPOSURE_ABSOLUTE": 0x009A0902, "V4L2_CID_EXPOSURE_AUTO_PRIORITY": 0x009A0903,
    "V4L2_CID_FOCUS_AUTO": 0x009A090C, "V4L2_CID_FOCUS_ABSOLUTE": 0x009A090A,
    "V4L2_CID_AUTOGAIN": 0x00980912, "V4L2_CID_GAIN": 0x00980913,
    "V4L2_CID_AUTO_WHITE_BALANCE": 0x0098090C, "V4L2_CID_WHITE_BALANCE_TEMPERATURE": 0x0098091A,
    "V4L2_EXPOSURE_MANUAL": 1,
}  # fmt: skip


@pytest.mark.parametrize("name", RECORDED)
def test_request_number_is_the_kernels(name):
    assert getattr(abi, name) == RECORDED[name]


def test_header_of_this_machine_says_the_same(tmp_path):
    compiler = shutil.which("cc")
    if compiler is None or not Path("/usr/include/linux/videodev2.h").exists():
        pytest.skip("no C compiler with linux/videodev2.h here; the recorded numbers are tested")
    wanted = {f"VIDIOC_{name}": number for name, number in RECORDED.items()} | VALUES
    wanted |= {_place(name): field.offset for name, field in PLACES.items()}
    lines = "".join(f'printf("%llu\\n", (unsigned long long)({expression}));\n' for expression in wanted)
    source = tmp_path / "abi.c"
    source.write_text(
        "#include <stdio.h>\n#include <stddef.h>\n#include <linux/videodev2.h>\nint main(void) {\n"
        + lines
        + "}\n"
    )
    subprocess.run([compiler, "-o", tmp_path / "abi", source], check=True, timeout=60)
    said = subprocess.run([tmp_path / "abi"], check=True, capture_output=True, text=True, timeout=10).stdout
    assert dict(zip(wanted, map(int, said.split()), strict=True)) == wanted


def _place(name: str) -> str:
    structure, _, field = name.partition(".")
    return f"offsetof(struct {structure}, {field})"


def test_pointers_are_64_bits_wide_here():
    assert ctypes.sizeof(ctypes.c_void_p) == 8
