"""Compiles bed.c into a temporary folder and binds it. GPL-3: it runs in tests alone and ships nowhere."""

import ctypes
import functools
import os
import shutil
import subprocess
import tempfile
from ctypes import POINTER, c_char, c_char_p, c_double, c_int, c_int64, c_uint8, c_uint32, c_void_p
from pathlib import Path

SOURCE = Path(__file__).with_name("bed.c")
PACKAGES = "gcc libc6-dev libsimavr-dev libelf-dev"
_PIN = (c_void_p, c_char, c_int)
SIGNATURES = {
    "bed_open": (c_void_p, (c_char_p, c_char_p, c_uint32, c_char)),
    "bed_close": (None, (c_void_p,)),
    "bed_run_to": (c_int, (c_void_p, c_double, c_int)),
    "bed_now_us": (c_double, (c_void_p,)),
    "bed_asleep_us": (c_double, (c_void_p,)),
    "bed_send": (None, (c_void_p, c_char_p, c_int)),
    "bed_unsent": (c_int, (c_void_p,)),
    "bed_drop_unsent": (None, (c_void_p,)),
    "bed_receive": (c_int, (c_void_p, POINTER(c_uint8), c_int)),
    "bed_level": (c_int, _PIN),
    "bed_edges": (c_uint32, _PIN),
    "bed_fell_us": (c_double, _PIN),
    "bed_pulse_us": (c_double, _PIN),
    "bed_high_us": (c_double, _PIN),
    "bed_duty": (c_double, _PIN),
    "bed_drive_pin": (None, (*_PIN, c_int)),
    "bed_adc": (None, (c_void_p, c_int, c_uint32)),
    "bed_memory": (c_int, (c_void_p, c_uint32)),
    "bed_write": (None, (c_void_p, c_uint32, c_uint8)),
    "bed_encoder": (None, (c_void_p, c_int, c_char, c_int, c_char, c_int)),
    "bed_encoder_to": (None, (c_void_p, c_int, c_int64, c_double)),
    "bed_encoder_edges": (c_int64, (c_void_p, c_int)),
    "bed_encoder_broken": (None, (c_void_p, c_int, c_int)),
    "bed_reset": (None, (c_void_p, c_int)),
    "bed_stall": (None, (c_void_p,)),
    "bed_unstall": (None, (c_void_p,)),
}


class BedMissing(RuntimeError):
    """The test bed cannot be built here; the message says what to install."""


@functools.cache
def library() -> ctypes.CDLL:
    """Return the library, compiled once in this process. Raises BedMissing without compiler or headers."""
    compiler = os.environ.get("CC") or shutil.which("gcc")
    if compiler is None:
        raise BedMissing(f"no gcc: apt install {PACKAGES}")
    with tempfile.TemporaryDirectory(prefix="tapreach-bed-") as folder:
        target = Path(folder) / "libbed.so"
        command = [compiler, "-O2", "-shared", "-fPIC", "-o", str(target), str(SOURCE), "-lsimavr", "-lelf"]
        made = subprocess.run(command, capture_output=True, text=True)
        if made.returncode:
            raise BedMissing(f"bed.c does not compile: apt install {PACKAGES}\n{made.stderr}")
        loaded = ctypes.CDLL(str(target))
    for name, (result, arguments) in SIGNATURES.items():
        function = getattr(loaded, name)
        function.restype, function.argtypes = result, arguments
    return loaded
