"""What the bed needs from Debian. Tests skip where it is missing, but under CI: there it is installed."""

import os
import shutil

import pytest
from tests.firmware.sim.library import PACKAGES, BedMissing, library


def _missing() -> str:
    if shutil.which("avr-gcc") is None:
        return "no avr-gcc: apt install gcc-avr avr-libc arduino-core-avr"
    try:
        library()
    except BedMissing as reason:
        return str(reason).splitlines()[0]
    return ""


def _reason() -> str:
    return "" if os.environ.get("CI") else _missing()


_REASON = _reason()
needs_bed = pytest.mark.skipif(bool(_REASON), reason=_REASON or f"needs {PACKAGES}")
