"""docs/hardware.md and its drawings show the pins that the firmware is built with."""

import importlib.util
import re
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest

from tapreach.drivers.arduino.boards import BOARDS

TOOLS = Path(__file__).resolve().parents[2] / "tools"


def load(name):
    spec = importlib.util.spec_from_file_location(name, TOOLS / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module  # dataclasses look their module up
    spec.loader.exec_module(module)
    return module


pins, generator = load("hardware_pins"), load("generate_hardware_page")
HINT = "run .venv/bin/python tools/generate_hardware_page.py"
SHOWN = generator.read_boards()
IDS = [board.name for board, _ in SHOWN]


def test_page_is_current():
    present = generator.PAGE.read_text(encoding="utf-8")
    assert present == generator.render_page(present), HINT


def test_drawings_are_current_and_none_is_left_over():
    made = generator.render_pictures()
    assert {path: path.read_text(encoding="utf-8") for path in made} == made, HINT
    assert set(generator.PICTURES.glob("wiring-*.svg")) == set(made)
    for text in made.values():
        ElementTree.fromstring(text)


def test_every_board_of_the_firmware_is_shown():
    titles = " ".join(board.title for board, _ in SHOWN)
    assert [b.title for b in BOARDS.values() if not all(w in titles for w in b.title.split(", "))] == []


@pytest.mark.parametrize(("board", "wires"), SHOWN, ids=IDS)
def test_no_pin_has_two_wires_and_the_host_keeps_its_own(board, wires):
    used = [wire.pin for wire in wires]
    assert len(used) == len(set(used)) == 18
    if board.name in ("uno", "mega"):
        assert not {"0", "1"} & set(used)


@pytest.mark.parametrize(("board", "wires"), SHOWN, ids=IDS)
def test_drawing_names_every_pin_and_what_it_is(board, wires):
    text = generator.render_pictures()[generator.PICTURES / f"wiring-{board.name}.svg"]
    shown = re.findall(r">([^<>]+)</text>", text)
    assert [w for w in wires if w.pin not in shown or w.meaning not in shown] == []


def test_reader_takes_the_branch_of_the_board_it_is_asked_for():
    text = pins.PINS.read_text(encoding="utf-8")
    uno, mega = (pins.pins_of(f"__AVR_ATmega{name}__", text) for name in ("328P", "2560"))
    assert uno["PWM"] == ("5", "6") and mega["PWM"] == ("4", "13")
    assert (uno["STANDBY"], uno["BATTERY"], mega["STOP"]) == (("A5",), ("A0",), ("28",))
    with pytest.raises(SystemExit, match="no branch"):
        pins.pins_of("__AVR_ATtiny85__", text)
