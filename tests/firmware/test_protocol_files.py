"""What is generated from firmware/protocol.toml is current, and the codec keeps what it is told."""

import importlib.util
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
_SPEC = importlib.util.spec_from_file_location(
    "generate_serial_protocol", ROOT / "tools" / "generate_serial_protocol.py"
)
assert _SPEC is not None and _SPEC.loader is not None
generator = importlib.util.module_from_spec(_SPEC)
sys.modules[_SPEC.name] = generator  # dataclasses look their module up
_SPEC.loader.exec_module(generator)

HINT = "run .venv/bin/python tools/generate_serial_protocol.py"
PROTOCOL = generator.read_protocol()


def test_python_codec_is_current():
    assert generator.PYTHON.read_text(encoding="utf-8") == generator.render_python(PROTOCOL), HINT


def test_header_is_current():
    assert generator.HEADER.read_text(encoding="utf-8") == generator.render_header(PROTOCOL), HINT


def test_page_is_current():
    present = generator.PAGE.read_text(encoding="utf-8")
    assert present == generator.render_page(PROTOCOL, present), HINT


def test_every_message_fits_a_frame():
    longest = max(message.size for message in PROTOCOL.messages)
    assert longest + 2 + 2 + 1 <= PROTOCOL.constants["longest_frame"][0]


def test_types_differ_and_tell_the_direction():
    types = [message.type for message in PROTOCOL.messages]
    assert len(set(types)) == len(types)
    assert all((message.type >= 0x80) == message.from_firmware for message in PROTOCOL.messages)
