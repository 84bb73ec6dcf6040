"""`tapreach two-tap` and `tapreach estimate` as a user types them."""

import json
import math
import re
import subprocess
import sys
from pathlib import Path

import pytest
from typer.testing import CliRunner

from tapreach.cli.estimate_file_doc import markdown
from tapreach.cli.main import app
from tapreach.cli.quantity import read_angle, read_length
from tapreach.errors import InputError

DOC = Path(__file__).resolve().parents[2] / "docs" / "estimate-file.md"
EXAMPLE = json.loads(re.search(r"```json\n(.*?)```", markdown(), re.S)[1])


def run(*arguments, text=None):
    return CliRunner().invoke(app, list(arguments), input=text)


@pytest.mark.parametrize("length", ["20cm", "0.2m", "200 mm", "+2e-1 m"])
def test_length_is_read_in_any_of_its_units(length):
    assert read_length("--advance", length) == pytest.approx(0.2)


@pytest.mark.parametrize("angle", ["12deg", "12°", "12 DEG", "0.20943951rad"])
def test_angle_is_read_in_any_of_its_units(angle):
    assert read_angle("--turn", angle) == pytest.approx(math.radians(12.0))


@pytest.mark.parametrize("bad", ["20", "20 furlongs", "nan m", "inf cm", "", "1e999m", "cm"])
def test_length_without_sense_names_what_is_right(bad):
    with pytest.raises(InputError, match="--advance is"):
        read_length("--advance", bad)


def test_two_tap_prints_both_frames_and_the_height_check():
    result = run(
        "two-tap",
        "--turn",
        "12°",
        "--advance",
        "20cm",
        "--focal",
        "24.03cm",
        "--alpha",
        "48.7",
        "--second",
        "414,-5",
    )
    assert result.exit_code == 0
    for expected in ("51.22 cm", "from O,", "from O_NEW", "height check"):
        assert expected in result.output


def test_two_tap_without_an_answer_says_why_and_exits_with_1():
    result = run("two-tap", "--turn", "12deg", "--advance", "0.2m", "--focal", "1170px", "--second", "100")
    assert result.exit_code == 1
    assert "at_infinity_or_behind" in result.output


@pytest.mark.parametrize(
    ("table", "figures"), [("1", ["24.24", "24.27"]), ("2", ["51.23", "262.05", "259.75"])]
)
def test_table_shows_computed_beside_published_figures(table, figures):
    output = run("two-tap", "--table", table).output
    assert all(figure in output for figure in figures)


def test_example_of_the_document_gives_a_position(tmp_path):
    file = tmp_path / "views.json"
    file.write_text(json.dumps(EXAMPLE))
    result = run("estimate", str(file), "--json")
    values = json.loads(result.output)
    assert values["status"] == "determined"
    assert 1.0 / values["inverse_depth"] == pytest.approx(1.0, rel=1e-3)
    assert values == json.loads(run("estimate", "-", "--json", text=json.dumps(EXAMPLE)).output)
    assert "position in the world" in run("estimate", str(file)).output


def test_result_without_a_depth_is_json_with_nulls():
    one_view = EXAMPLE | {"views": EXAMPLE["views"][:1]}
    values = json.loads(run("estimate", "-", "--json", text=json.dumps(one_view)).output)
    assert (values["status"], values["relative_sd"], values["point_in_world"]) == ("degenerate", None, None)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("{nope", "Invalid JSON"),
        (json.dumps(EXAMPLE).replace("319.5,", "NaN,", 1), "finite number"),
        (json.dumps(EXAMPLE | {"speed": 1}), "speed: Extra inputs"),
        (json.dumps(EXAMPLE | {"mount": None}), "views.0: a pose of the base needs the mount"),
        (json.dumps(EXAMPLE | {"pose_covariance": [[1.0]]}), "only one of odometry and pose_covariance"),
        (json.dumps(EXAMPLE).replace("491.6", "700.0"), "views.1: pixel .* outside the picture"),
    ],
)
def test_file_that_cannot_be_used_is_one_clear_paragraph(text, message):
    command = [sys.executable, "-c", "from tapreach.cli.main import main; main()", "estimate", "-"]
    result = subprocess.run(command, input=text, capture_output=True, text=True, check=False, timeout=60)
    assert result.returncode == 2
    assert re.search(message, result.stderr)
    assert "Traceback" not in result.stderr and result.stdout == ""


def test_missing_file_is_named():
    result = run("estimate", "no-such-file.json")
    assert isinstance(result.exception, InputError)
    assert "no-such-file.json" in str(result.exception)


def test_document_of_the_file_is_up_to_date():
    assert DOC.read_text(encoding="utf-8") == markdown()


def test_schema_is_printed_as_json():
    assert json.loads(run("estimate", "--schema").output)["title"] == "EstimateFile"
