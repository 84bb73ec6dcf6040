"""Documents stay true: their commands and code run, links lead somewhere, the changelog knows the version.

How a fence is treated, by its language:

- `console`: every line that starts with "$ " is a command. `tapreach ...` is executed, must succeed, and what
  is shown below it must be what it prints ("..." stands for anything). A command that serves until it is
  stopped ends with "# until Ctrl-C": it is started on a free port, must print its address and stop cleanly.
  `make ...` is checked to be a target. Nothing else may stand in a console fence.
- `python`: all fences of one page run one after the other in one fresh process, warnings as errors.
- `json`, `toml`: must parse.
- `text`, `mermaid` and fences without a language are not executed; `bash` and `sh` are refused in favour of
  `console`.
"""

import fnmatch
import json
import os
import re
import shlex
import signal
import socket
import subprocess
import sys
import tomllib
from dataclasses import dataclass
from pathlib import Path

import pytest
from tests.scenarios.running import tapreach_run

ROOT = Path(__file__).resolve().parents[1]
PAGES = [
    ROOT / "README.md",
    ROOT / "CONTRIBUTING.md",
    ROOT / "CHANGELOG.md",
    *sorted(ROOT.glob("docs/**/*.md")),
]
EXAMPLES = sorted(ROOT.glob("examples/**/*.py"))
WITH_ROBOT = [path for path in EXAMPLES if "tapreach.client" in path.read_text(encoding="utf-8")]
WITHOUT_ROBOT = [path for path in EXAMPLES if path not in WITH_ROBOT]
TAPREACH = Path(sys.executable).with_name("tapreach")
SERVES = "# until Ctrl-C"
BOUND_S = 120

LANGUAGES = {"console", "python", "json", "toml", "text", "mermaid", ""}
FENCE = re.compile(r"^```([\w-]*)[^\n]*\n(.*?)^```\s*$", re.MULTILINE | re.DOTALL)
LINK = re.compile(r"!?\[[^\]]*\]\(([^)\s]+)\)")


@dataclass(frozen=True)
class Fence:
    page: Path
    line: int
    language: str
    body: str

    def __str__(self) -> str:
        return f"{name_of(self.page)}:{self.line}"


@dataclass(frozen=True)
class Command:
    fence: Fence
    words: list[str]
    serves: bool
    shown: str

    def __str__(self) -> str:
        return f"{self.fence} {shlex.join(self.words)}"


def name_of(page: Path) -> str:
    return str(page.relative_to(ROOT)) if page.is_relative_to(ROOT) else page.name


def fences_of(page: Path) -> list[Fence]:
    text = page.read_text(encoding="utf-8")
    return [Fence(page, text.count("\n", 0, m.start()) + 1, m[1], m[2]) for m in FENCE.finditer(text)]


def commands_of(fence: Fence) -> list[Command]:
    """The commands of a console fence, each with the lines shown below it."""
    found = []
    for block in re.split(r"^\$ ", fence.body, flags=re.MULTILINE)[1:]:
        line, _, shown = block.replace("\\\n", " ").partition("\n")
        found.append(
            Command(fence, shlex.split(line, comments=True), line.rstrip().endswith(SERVES), shown.strip())
        )
    return found


def agrees(shown: str, printed: str) -> bool:
    """Is `printed` what the page shows? Space at line ends does not count; "..." stands for anything."""
    pattern = "\n".join(line.rstrip() for line in shown.strip().splitlines())
    actual = "\n".join(line.rstrip() for line in printed.strip().splitlines())
    return fnmatch.fnmatchcase(actual, glob_of(pattern))


def glob_of(pattern: str) -> str:
    return "*".join(re.sub(r"([*?[])", r"[\1]", piece) for piece in pattern.split("..."))


FENCES = [fence for page in PAGES for fence in fences_of(page)]
COMMANDS = [command for fence in FENCES if fence.language == "console" for command in commands_of(fence)]
RUN = [command for command in COMMANDS if command.words[:1] == ["tapreach"] and not command.serves]
SERVE = [command for command in COMMANDS if command.words[:1] == ["tapreach"] and command.serves]
MAKE = [command for command in COMMANDS if command.words[:1] == ["make"]]


def environment() -> dict[str, str]:
    return os.environ | {"COLUMNS": "120", "NO_COLOR": "1", "TERM": "dumb", "PYTHONUNBUFFERED": "1"}


def run(words: list[str], folder: Path, bound_s: float = BOUND_S) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        words,
        cwd=folder,
        env=environment(),
        capture_output=True,
        text=True,
        timeout=bound_s,
        stdin=subprocess.DEVNULL,
    )


@pytest.mark.parametrize("fence", FENCES, ids=str)
def test_fence_has_a_language_that_is_checked(fence: Fence) -> None:
    assert fence.language in LANGUAGES


@pytest.mark.parametrize("command", COMMANDS, ids=str)
def test_command_is_one_that_can_be_checked(command: Command) -> None:
    assert command.words[0] in {"tapreach", "make"}


@pytest.mark.parametrize("command", RUN, ids=str)
def test_command_prints_what_the_page_shows(command: Command) -> None:
    done = run([str(TAPREACH), *command.words[1:]], ROOT)
    assert done.returncode == 0, done.stderr
    assert agrees(command.shown or "...", done.stdout), done.stdout


@pytest.mark.parametrize("command", SERVE, ids=str)
def test_serving_command_prints_its_address_and_stops(command: Command) -> None:
    with socket.create_server(("127.0.0.1", 0)) as free:
        port = free.getsockname()[1]
    words = [str(TAPREACH), *command.words[1:], "--port", str(port)]
    with subprocess.Popen(
        words, cwd=ROOT, env=environment(), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
    ) as server:
        try:
            printed = read_until(server, f":{port}")
            server.send_signal(signal.SIGINT)
            rest, _ = server.communicate(timeout=BOUND_S)
        finally:
            server.kill()
    assert f":{port}" in printed, printed
    assert "Traceback" not in printed + rest, rest
    assert server.returncode in {0, 130}, rest


def read_until(server: "subprocess.Popen[str]", wanted: str) -> str:
    """What the server printed up to the line with `wanted`, or to its end; pytest-timeout bounds the wait."""
    assert server.stdout is not None
    printed = ""
    for line in server.stdout:
        printed += line
        if wanted in line:
            break
    return printed


@pytest.mark.parametrize("command", MAKE, ids=str)
def test_make_target_exists(command: Command) -> None:
    targets = re.findall(r"^(\w+):", (ROOT / "Makefile").read_text(encoding="utf-8"), re.MULTILINE)
    assert command.words[1] in targets


@pytest.mark.parametrize(
    "page", [page for page in PAGES if any(f.language == "python" for f in fences_of(page))], ids=name_of
)
def test_python_of_a_page_runs(page: Path, tmp_path: Path) -> None:
    code = "\n".join(fence.body for fence in fences_of(page) if fence.language == "python")
    done = run([sys.executable, "-W", "error", "-c", code], tmp_path)
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("fence", [f for f in FENCES if f.language in {"json", "toml"}], ids=str)
def test_data_of_a_page_parses(fence: Fence) -> None:
    json.loads(fence.body) if fence.language == "json" else tomllib.loads(fence.body)


@pytest.mark.parametrize("example", WITHOUT_ROBOT, ids=name_of)
def test_example_runs(example: Path, tmp_path: Path) -> None:
    done = run([sys.executable, "-W", "error", str(example)], tmp_path)
    assert done.returncode == 0, done.stderr
    assert done.stdout.strip(), "an example shows something"


@pytest.mark.timeout(3 * BOUND_S)
@pytest.mark.parametrize("example", WITH_ROBOT, ids=name_of)
def test_example_runs_with_the_simulated_robot(example: Path, tmp_path: Path) -> None:
    with tapreach_run(tmp_path, "--scene", "room") as robot:
        done = run([sys.executable, "-W", "error", str(example), robot.address], tmp_path, 2 * BOUND_S)
    assert done.returncode == 0, done.stderr
    assert re.search("^(planned|refused|failed|stopped) .", done.stdout, re.MULTILINE), done.stdout


@pytest.mark.parametrize("page", PAGES, ids=name_of)
def test_links_lead_somewhere(page: Path) -> None:
    assert dead_links(page) == []


def dead_links(page: Path) -> list[str]:
    """Links to files that are not there, and to headings that the other page does not have."""
    text = FENCE.sub("", page.read_text(encoding="utf-8"))
    return [link for link in LINK.findall(text) if "://" not in link and not leads_somewhere(page, link)]


def leads_somewhere(page: Path, link: str) -> bool:
    path, _, anchor = link.partition("#")
    target = page if not path else page.parent / path
    return target.exists() and (not anchor or anchor in anchors_of(target))


def anchors_of(page: Path) -> set[str]:
    headings = re.findall(r"^#+ (.+)$", page.read_text(encoding="utf-8"), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


def test_changelog_has_the_version_of_the_package() -> None:
    version = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["version"]
    headings = re.findall(r"^## (\S+)", (ROOT / "CHANGELOG.md").read_text(encoding="utf-8"), re.MULTILINE)
    assert headings[:2] == ["Unreleased", version]


def test_every_decision_is_in_the_index() -> None:
    folder = ROOT / "docs" / "decisions"
    index = (folder / "README.md").read_text(encoding="utf-8")
    assert [page.name for page in folder.glob("0*.md") if f"({page.name})" not in index] == []


def test_fence_reader_finds_commands_and_what_they_show(tmp_path: Path) -> None:
    page = tmp_path / "page.md"
    page.write_text("a\n```console\n$ tapreach x --y 'a b'\none\ntwo\n$ tapreach run  # until Ctrl-C\n```\n")
    (fence,) = fences_of(page)
    first, second = commands_of(fence)
    assert (fence.line, first.words, first.shown) == (2, ["tapreach", "x", "--y", "a b"], "one\ntwo")
    assert (second.words, second.serves, second.shown) == (["tapreach", "run"], True, "")


@pytest.mark.parametrize(
    ("shown", "printed", "same"),
    [
        ("a\nb", "a  \nb\n", True),
        ("a ... c", "a 12 c", True),
        ("a\n...", "a\nb\nc", True),
        ("x [m]", "x [m]", True),
        ("a", "a\nb", False),
        ("x [m]", "x m", False),
    ],
)
def test_shown_output_is_compared(shown: str, printed: str, same: bool) -> None:
    assert agrees(shown, printed) is same


def test_dead_link_is_found(tmp_path: Path) -> None:
    page = tmp_path / "page.md"
    page.write_text("# Head line\n[a](none.md) [b](#head-line) [c](#nowhere) [d](page.md#head-line)\n")
    assert dead_links(page) == ["none.md", "#nowhere"]
