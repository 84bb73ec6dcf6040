"""Small files: long ones need a reason here; the median and the 90th percentile bound the rest."""

import statistics
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
FOLDERS = ("src", "tests", "web", "examples", "tools", "models", "bench", "firmware")
SUFFIXES = {".py", ".js", ".css", ".html", ".sh", ".h", ".cpp", ".ino"}

LONGEST = 400
LARGEST_MEDIAN = 150
LARGEST_P90 = 320

# path -> why this file may be longer than LONGEST
REASONS: dict[str, str] = {
    "web/net/messages.js": "generated: one typedef for every message",
    "src/tapreach/drivers/arduino/wire.py": "generated: one class for every message",
}


def line_counts(root: Path) -> dict[str, int]:
    paths = (path for folder in FOLDERS for path in (root / folder).rglob("*") if path.suffix in SUFFIXES)
    return {
        str(path.relative_to(root)): len(path.read_text(encoding="utf-8").splitlines())
        for path in paths
        if path.name != "__init__.py" and "node_modules" not in path.parts
    }


def too_long(counts: dict[str, int], reasons: dict[str, str]) -> list[str]:
    return sorted(
        f"{path}: {count} lines" for path, count in counts.items() if count > LONGEST and path not in reasons
    )


def test_long_files_have_a_reason() -> None:
    assert too_long(line_counts(ROOT), REASONS) == []


def test_every_reason_is_still_needed() -> None:
    counts = line_counts(ROOT)
    assert [path for path in REASONS if counts.get(path, 0) <= LONGEST] == []


def test_median_and_90th_percentile_are_in_the_budget() -> None:
    source = [count for path, count in line_counts(ROOT).items() if path.startswith("src/")]
    assert statistics.median(source) <= LARGEST_MEDIAN
    assert statistics.quantiles(source, n=10)[-1] < LARGEST_P90


def test_long_file_without_a_reason_is_named(tmp_path: Path) -> None:
    (tmp_path / "src").mkdir()
    (tmp_path / "src" / "long.py").write_text("x = 1\n" * (LONGEST + 1), encoding="utf-8")
    assert too_long(line_counts(tmp_path), {}) == [f"src/long.py: {LONGEST + 1} lines"]
    assert too_long(line_counts(tmp_path), {"src/long.py": "a table"}) == []
