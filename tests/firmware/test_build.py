"""The firmware is built for every board and fits it, by the commands that a user has."""

import os

import pytest
from typer.testing import CliRunner

from tapreach.cli.firmware import BoardName, firmware
from tapreach.drivers.arduino.boards import BOARDS, board_named
from tapreach.drivers.arduino.build import PACKAGES, build, missing_tools
from tapreach.errors import InputError, SetupError

needs_compiler = pytest.mark.skipif(
    bool(missing_tools()) and not os.environ.get("CI"),
    reason=f"needs the Debian packages {' '.join(PACKAGES)}",
)


@needs_compiler
@pytest.mark.parametrize("name", sorted(BOARDS))
def test_firmware_fits_every_board(name, tmp_path):
    built = build(BOARDS[name], tmp_path / "firmware.elf")
    assert built.elf.read_bytes()[:4] == b"\x7fELF"
    assert built.is_within_limits
    assert built.flash > 5000


@needs_compiler
def test_every_variant_compiles_at_once(tmp_path):
    definitions = ("MOTOR_TB6612", "ENCODER_SINGLE", "STOP_NORMALLY_CLOSED", "HOST_BAUD=57600")
    assert build(BOARDS["uno"], tmp_path / "firmware.elf", definitions).is_within_limits


@needs_compiler
def test_build_command_leaves_the_image_and_says_the_size(tmp_path):
    target = tmp_path / "made" / "uno.elf"
    done = CliRunner().invoke(firmware, ["build", "--board", "uno", "--out", str(target)])
    assert done.exit_code == 0, done.output
    assert "of 32256 bytes" in done.output
    assert target.with_suffix(".hex").read_text(encoding="ascii").startswith(":")


@needs_compiler
def test_compiler_that_refuses_is_heard(tmp_path):
    with pytest.raises(SetupError, match=r"avr-g\+\+ failed"):
        build(BOARDS["uno"], tmp_path / "firmware.elf", ("HOST_BAUD=nothing_known",))


def test_missing_toolchain_is_named_with_the_way_to_get_it(tmp_path, monkeypatch):
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(SetupError, match=r"avr-gcc.*apt-get install gcc-avr"):
        build(BOARDS["uno"], tmp_path / "firmware.elf")


def test_missing_avrdude_is_named_before_anything_is_built(tmp_path, monkeypatch):
    monkeypatch.setenv("PATH", str(tmp_path))
    done = CliRunner().invoke(firmware, ["flash", "--board", "uno", "--port", str(tmp_path)])
    assert isinstance(done.exception, SetupError)
    assert "apt-get install avrdude" in str(done.exception)


@needs_compiler
@pytest.mark.parametrize("definition", ["", "-v", "A B", "A=1;2", "@file"])
def test_definition_that_is_none_is_refused(definition, tmp_path):
    with pytest.raises(InputError, match="is no definition"):
        build(BOARDS["uno"], tmp_path / "firmware.elf", (definition,))


def test_command_offers_every_board():
    assert {name.value for name in BoardName} == set(BOARDS)


def test_unknown_board_is_told_the_known_ones():
    with pytest.raises(InputError, match="leonardo, mega, promicro, uno, yun"):
        board_named("due")
