"""The two commands on machines that lack something: what is missing is found, named, and asked for once.

Each test runs the shell files of tools/ in a folder of its own, on a PATH of stubs and a few real tools.
"""

import shutil
import subprocess
from dataclasses import dataclass
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
REAL_TOOLS = (
    "sh",
    "dirname",
    "basename",
    "cksum",
    "cat",
    "df",
    "awk",
    "uname",
    "grep",
    "env",
    "mktemp",
    "rm",
)
NEW_PYTHON = (
    'case "$*" in --version) echo "Python 3.12.1" ;; '
    "*ensurepip*) exit {ensurepip} ;; *check_graphics*) exit 1 ;; esac"
)
OLD_PYTHON = 'case "$*" in --version) echo "Python 3.9.2" ;; *) exit 1 ;; esac'


@dataclass(frozen=True)
class Machine:
    """A folder with the scripts, and a PATH with nothing on it but what the test put there."""

    checkout: Path
    programs: Path

    def has(self, name: str, script: str) -> None:
        path = self.programs / name
        path.write_text(f"#!/bin/sh\n{script}\n", encoding="utf-8")
        path.chmod(0o755)

    def runs(self, *words: str, **environment: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            [str(self.programs / "sh"), *words],
            cwd=self.checkout,
            env={"PATH": str(self.programs), "HOME": str(self.checkout), **environment},
            capture_output=True,
            text=True,
            stdin=subprocess.DEVNULL,
            timeout=60,
        )

    def calls(self, function: str, **environment: str) -> subprocess.CompletedProcess[str]:
        libraries = "".join(
            f". tools/lib/{path.name}; " for path in sorted((ROOT / "tools/lib").glob("*.sh"))
        )
        return self.runs("-euc", libraries + function, **environment)


@pytest.fixture
def machine(tmp_path: Path) -> Machine:
    checkout, programs = tmp_path / "a place with spaces", tmp_path / "bin"
    shutil.copytree(ROOT / "tools", checkout / "tools")
    shutil.copy(ROOT / "pyproject.toml", checkout)
    programs.mkdir()
    for name in REAL_TOOLS:
        found = shutil.which(name)
        assert found is not None
        (programs / name).symlink_to(found)
    made = Machine(checkout, programs)
    made.has("id", "echo 1000")
    return made


def test_python_that_is_too_old_is_named(machine: Machine) -> None:
    machine.has("python3", OLD_PYTHON)
    done = machine.runs("tools/run.sh")
    assert done.returncode == 1
    assert "Python 3.11 or later is needed; this machine has Python 3.9.2" in done.stderr
    assert "TAPREACH_PYTHON=" in done.stderr


def test_newer_python_beside_the_old_one_is_taken(machine: Machine) -> None:
    machine.has("python3", OLD_PYTHON)
    machine.has("python3.12", NEW_PYTHON.format(ensurepip=0))
    assert machine.calls('find_python; echo "$python"').stdout.strip().endswith("python3.12")


def test_missing_packages_are_named_in_one_line_with_sudo(machine: Machine) -> None:
    machine.has("python3", NEW_PYTHON.format(ensurepip=1))
    machine.has("sudo", "echo asked; exit 1")
    machine.has("apt-get", "echo apt ran; exit 1")
    done = machine.runs("tools/run.sh")
    line = "sudo apt-get install -y --no-install-recommends python3-venv libegl1 libgl1-mesa-dri"
    assert done.returncode == 1
    assert line in done.stderr
    assert "asked" not in done.stdout, "nobody is there to answer, so sudo is not run"


def test_machine_without_any_python_is_told_which_package(machine: Machine) -> None:
    done = machine.runs("tools/run.sh")
    assert done.returncode == 1
    assert (
        "su -c 'apt-get update && apt-get install -y --no-install-recommends python3 python3-venv"
        in done.stderr
    )


def test_root_installs_without_asking(machine: Machine) -> None:
    machine.has("id", "echo 0")
    machine.has("apt-get", 'echo "$*" >>apt.log')
    done = machine.calls("want_package alpha beta; install_packages")
    assert done.returncode == 0, done.stderr
    assert "Installing system packages: alpha beta" in done.stdout
    assert (machine.checkout / "apt.log").read_text().splitlines() == [
        "update",
        "install -y --no-install-recommends alpha beta",
    ]


def test_apt_that_fails_shows_its_own_words(machine: Machine) -> None:
    machine.has("id", "echo 0")
    machine.has("apt-get", "echo no route to the mirror; exit 100")
    done = machine.calls("want_package alpha; install_packages")
    assert done.returncode == 1
    assert "no route to the mirror" in done.stderr


def test_yes_beforehand_runs_sudo(machine: Machine) -> None:
    machine.has("sudo", '"$@"')
    machine.has("apt-get", 'echo "$*" >>apt.log')
    assert machine.calls("want_package alpha; install_packages", TAPREACH_YES="1").returncode == 0
    assert "alpha" in (machine.checkout / "apt.log").read_text()


def test_stamp_holds_until_pyproject_changes(machine: Machine) -> None:
    (machine.checkout / ".venv").mkdir()
    stamp = 'install_key "" >.venv/.installed; '
    assert machine.calls(stamp + 'is_installed ""').returncode == 0
    (machine.checkout / "pyproject.toml").write_text("changed")
    assert machine.calls('is_installed ""').returncode == 1


def test_stamp_does_not_hold_in_another_folder(machine: Machine) -> None:
    (machine.checkout / ".venv").mkdir()
    machine.calls('install_key "" >.venv/.installed')
    moved = machine.checkout.with_name("moved")
    machine.checkout.rename(moved)
    assert Machine(moved, machine.programs).calls('is_installed ""').returncode == 1


def test_full_disk_is_named_before_anything_is_installed(machine: Machine) -> None:
    (machine.programs / "df").unlink()
    machine.has("df", "printf 'head\\nx 1 1 12 1 /\\n'")
    done = machine.calls("require_space 1500")
    assert done.returncode == 1
    assert "only 12 MB are free on this disk and about 1500 MB are needed" in done.stderr


def test_snap_stub_is_not_taken_for_a_browser(machine: Machine) -> None:
    machine.has("chromium-browser", "echo 'requires the chromium snap'; exit 1")
    assert machine.calls('find_chromium; echo "[$chromium]"').stdout == "[]\n"


def test_named_browser_goes_first(machine: Machine) -> None:
    machine.has("chromium", "echo Chromium 140")
    machine.has("mine", "echo Chrome 141")
    found = machine.calls('find_chromium; echo "$chromium"', TAPREACH_CHROMIUM=str(machine.programs / "mine"))
    assert found.stdout.strip() == str(machine.programs / "mine")


def test_named_browser_that_does_not_run_is_an_error(machine: Machine) -> None:
    done = machine.calls("find_chromium", TAPREACH_CHROMIUM="/nowhere/chrome")
    assert done.returncode == 1
    assert "TAPREACH_CHROMIUM=/nowhere/chrome is not a browser that runs" in done.stderr
