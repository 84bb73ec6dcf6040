from pathlib import Path

import pytest

from tapreach.bench.document import benchmarks_document
from tapreach.bench.report import read_report

DOCS = Path(__file__).resolve().parents[2] / "docs"
REPORTS = sorted((DOCS / "benchmarks").glob("*.json"))


def test_benchmarks_page_is_the_generated_one():
    assert (DOCS / "benchmarks.md").read_text(encoding="utf-8") == benchmarks_document(DOCS / "benchmarks")


def test_both_benches_are_published():
    assert {path.stem for path in REPORTS} >= {"control", "video"}


@pytest.mark.parametrize("path", REPORTS, ids=lambda path: path.stem)
def test_published_run_is_a_full_one(path):
    report = read_report(path)
    assert report.bench == path.stem
    assert not report.is_smoke
