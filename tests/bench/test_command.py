import shutil
from pathlib import Path

import pytest
from typer.testing import CliRunner

from tapreach.cli.main import app

DOCS = Path(__file__).resolve().parents[2] / "docs"


def invoke(*arguments: str):
    return CliRunner().invoke(app, ["bench", *arguments], catch_exceptions=False)


@pytest.mark.parametrize("name", ["video", "control"])
def test_bench_offers_a_short_form_and_json(name):
    result = invoke(name, "--help")
    assert result.exit_code == 0
    assert "--smoke" in result.output
    assert "--json" in result.output


@pytest.mark.parametrize("seconds", ["0", "-3", "soon"])
def test_impossible_duration_is_refused(seconds):
    assert invoke("video", "--seconds", seconds).exit_code == 2


def test_document_is_written_from_the_json(tmp_path):
    shutil.copytree(DOCS / "benchmarks", tmp_path / "benchmarks")
    assert invoke("document", "--docs", str(tmp_path)).exit_code == 0
    assert (tmp_path / "benchmarks.md").read_bytes() == (DOCS / "benchmarks.md").read_bytes()
