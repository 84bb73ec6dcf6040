"""Rules of the house that a machine can check: one clock, no stray prints, no machine named."""

import ast
import json
import re
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
SOURCE = ROOT / "src" / "tapreach"
THE_CLOCK = "robot/clock.py"

# Reading a clock or waiting by one. The handed-in Clock does all three.
CLOCK_MODULES = {"time"}
WALL_CLOCK = {"now", "utcnow", "today"}
# Randomness is handed in as a seeded generator. Only these names of `random` and `np.random` make one.
SEEDED = {"Random", "Generator", "default_rng", "SeedSequence", "PCG64", "BitGenerator"}
EMPTY_NAMES = {"manager", "helper", "helpers", "utils", "util", "misc", "common"}

TEXT_SUFFIXES = {
    ".py",
    ".js",
    ".css",
    ".html",
    ".md",
    ".toml",
    ".json",
    ".sh",
    ".xml",
    ".yml",
    ".yaml",
    ".txt",
    "",
}
MACHINE_PATH = re.compile(r"(?<![\w.:/-])/(?:home|Users|root|work|mnt|data|scratch)/[\w.-]+")
ADDRESS = re.compile(r"https?://([\w.-]+)", re.IGNORECASE)
# Hosts that our texts may name: this machine, licences, and the standards we follow.
KNOWN_HOSTS = {"localhost", "testserver", "www.w3.org", "www.apache.org", "keepachangelog.com", "semver.org"}
RESERVED = (".example", ".invalid", ".test", ".localhost", "example.com")


def tracked_files() -> list[Path]:
    listed = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, check=True).stdout
    return [ROOT / name for name in listed.decode().split("\0") if name and (ROOT / name).is_file()]


def text_files() -> Iterator[tuple[str, str]]:
    for path in tracked_files():
        if path.suffix in TEXT_SUFFIXES and path.name not in {"LICENSE", "package-lock.json", "OFL.txt"}:
            yield str(path.relative_to(ROOT)), path.read_text(encoding="utf-8")


def source_files() -> Iterator[tuple[str, str]]:
    for path in sorted(SOURCE.rglob("*.py")):
        yield str(path.relative_to(SOURCE)), path.read_text(encoding="utf-8")


def clock_uses(code: str) -> list[str]:
    """Every use of the module `time` and of the wall clock in this source."""
    found = []
    for node in ast.walk(ast.parse(code)):
        if isinstance(node, ast.Import):
            found += [f"line {node.lineno}: import {a.name}" for a in node.names if a.name in CLOCK_MODULES]
        elif isinstance(node, ast.ImportFrom) and node.module in CLOCK_MODULES:
            found.append(f"line {node.lineno}: from {node.module} import ...")
        elif isinstance(node, ast.Attribute) and node.attr in WALL_CLOCK and names_datetime(node.value):
            found.append(f"line {node.lineno}: datetime.{node.attr}")
    return found


def names_datetime(node: ast.expr) -> bool:
    return (isinstance(node, ast.Name) and node.id in {"datetime", "date"}) or (
        isinstance(node, ast.Attribute) and node.attr in {"datetime", "date"}
    )


def hidden_draws(code: str) -> list[str]:
    """Every use of a generator that nobody seeded: `random.choice`, `np.random.normal`, `default_rng()`."""
    tree = ast.parse(code)
    imported = {a.name for node in ast.walk(tree) if isinstance(node, ast.Import) for a in node.names}
    return [f"line {line}: {draw}" for line, draw in draws(tree, "random" in imported)]


def draws(tree: ast.AST, imports_random: bool) -> Iterator[tuple[int, str]]:
    modules = {"np.random", "numpy.random"} | ({"random"} if imports_random else set())
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and node.module == "random":
            yield from ((node.lineno, a.name) for a in node.names if a.name not in SEEDED)
        elif (
            isinstance(node, ast.Attribute) and node.attr not in SEEDED and ast.unparse(node.value) in modules
        ):
            yield node.lineno, ast.unparse(node)
        elif isinstance(node, ast.Call) and not node.args and not node.keywords:
            name = ast.unparse(node.func)
            if name.split(".")[-1] in {"default_rng", "Random"}:
                yield node.lineno, f"{name}() without a seed"


def prints(code: str) -> list[str]:
    """Every print to stdout. A dying process may leave a last word on stderr (`file=sys.stderr`)."""
    calls = (node for node in ast.walk(ast.parse(code)) if isinstance(node, ast.Call))
    named = (call for call in calls if isinstance(call.func, ast.Name) and call.func.id == "print")
    return [f"line {c.lineno}: print" for c in named if "file" not in {word.arg for word in c.keywords}]


def machine_words(text: str) -> list[str]:
    hosts = [host for host in ADDRESS.findall(text) if not is_known(host.lower())]
    return MACHINE_PATH.findall(text) + hosts


def is_known(host: str) -> bool:
    if host in KNOWN_HOSTS or host.endswith(RESERVED):
        return True
    return re.fullmatch(r"(127|10|192\.168|192\.0\.2|169\.254)(\.\d+)+", host) is not None


def test_only_the_clock_reads_the_time() -> None:
    assert {p: uses for p, code in source_files() if p != THE_CLOCK and (uses := clock_uses(code))} == {}


def test_randomness_is_handed_in() -> None:
    assert {p: uses for p, code in source_files() if (uses := hidden_draws(code))} == {}


def test_nothing_below_the_commands_prints() -> None:
    assert {
        p: uses for p, code in source_files() if not p.startswith("cli/") and (uses := prints(code))
    } == {}


def test_modules_say_what_they_hold() -> None:
    assert [p for p, _ in source_files() if Path(p).stem in EMPTY_NAMES] == []


def test_no_module_is_empty() -> None:
    assert [p for p, code in source_files() if not code.strip()] == []


def test_tracked_files_name_no_machine_and_no_unknown_host() -> None:
    here = Path(__file__).name
    found = {p: words for p, text in text_files() if Path(p).name != here and (words := machine_words(text))}
    assert found == {}


def test_lock_file_names_no_place_of_download() -> None:
    packages = json.loads((ROOT / "package-lock.json").read_text(encoding="utf-8"))["packages"]
    assert [name for name, entry in packages.items() if "resolved" in entry] == []
    assert all("integrity" in entry for name, entry in packages.items() if name)


def test_page_needs_no_network() -> None:
    pattern = re.compile(r"""(?:src|href|from|import|url)\s*[=(]?\s*["']?(?:https?:)?//(?!localhost)""")
    pages = [path for path in (ROOT / "web").rglob("*") if path.suffix in {".js", ".html", ".css"}]
    assert [str(p.relative_to(ROOT)) for p in pages if pattern.search(p.read_text(encoding="utf-8"))] == []


@pytest.mark.parametrize(
    "code",
    [
        "import time",
        "from time import monotonic_ns",
        "def f():\n    import time",
        "datetime.datetime.now()",
        "date.today()",
    ],
)
def test_reading_a_clock_is_caught(code: str) -> None:
    assert clock_uses(code)


@pytest.mark.parametrize(
    "code", ["from tapreach.robot.clock import Clock", "clock.now_ns()", "import datetime"]
)
def test_handed_in_clock_is_not_caught(code: str) -> None:
    assert clock_uses(code) == []


@pytest.mark.parametrize(
    "text", ["see /home/anna/rover", "cd /root/rover", "index https://packages.internal/simple"]
)
def test_machine_words_are_caught(text: str) -> None:
    assert machine_words(text)


@pytest.mark.parametrize(
    "text", ["http://localhost:8080/", "docs/robots/home.md", "http://127.0.0.1:1/", "a/work/b"]
)
def test_plain_words_are_not_caught(text: str) -> None:
    assert machine_words(text) == []


@pytest.mark.parametrize(
    "code",
    [
        "import random\nrandom.shuffle(x)",
        "from random import choice",
        "np.random.normal(0, 1)",
        "np.random.default_rng()",
        "import random\nrandom.Random()",
    ],
)
def test_hidden_randomness_is_caught(code: str) -> None:
    assert hidden_draws(code)


@pytest.mark.parametrize(
    "code",
    [
        "import random\nrandom.Random(seed)",
        "np.random.default_rng(7)",
        "def f(random: np.random.Generator):\n    random.normal(0, 1)",
    ],
)
def test_seeded_randomness_is_not_caught(code: str) -> None:
    assert hidden_draws(code) == []


def test_print_is_caught() -> None:
    assert prints("def f():\n    print(1)") == ["line 2: print"]
