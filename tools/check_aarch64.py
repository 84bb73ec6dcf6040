"""Does every dependency come as a wheel for a 64-bit Raspberry Pi OS? Resolves, and installs nothing.

    .venv/bin/python tools/check_aarch64.py [PYTHON ...]

PYTHON: 3.11 (Debian 12) and 3.13 (Debian 13) unless named. Exit code 1 where one is missing.
"""

import json
import subprocess
import sys
import tempfile
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PYTHONS = ("3.11", "3.13")
PLATFORMS = (
    "manylinux_2_28_aarch64",
    "manylinux_2_27_aarch64",
    "manylinux_2_17_aarch64",
    "manylinux2014_aarch64",
)
"""What glibc 2.36 of Debian 12 runs; newer tags are left out on purpose."""
BOUND_S = 120


def dependencies() -> list[str]:
    """Return what pyproject.toml asks for."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    return list(project["dependencies"])


def resolve(requirements: list[str], python: str) -> list[str]:
    """Return the wheels' file names for these and all that they need. Raises RuntimeError by pip."""
    with tempfile.TemporaryDirectory() as folder:
        report = Path(folder) / "report.json"
        words = [sys.executable, "-m", "pip", "install", "--dry-run", "--quiet", "--ignore-installed"]
        words += ["--disable-pip-version-check", "--only-binary=:all:", "--implementation=cp"]
        words += [f"--python-version={python}", *(f"--platform={tag}" for tag in PLATFORMS)]
        words += [f"--target={folder}/none", f"--report={report}", *requirements]
        done = subprocess.run(words, capture_output=True, text=True, timeout=BOUND_S)
        if done.returncode != 0:
            raise RuntimeError(done.stderr.strip())
        found = json.loads(report.read_text(encoding="utf-8"))["install"]
    return sorted(each["download_info"]["url"].rpartition("/")[2] for each in found)


def main(pythons: list[str]) -> int:
    """Check each Python."""
    for python in pythons or PYTHONS:
        try:
            wheels = resolve(dependencies(), python)
        except RuntimeError as error:
            print(f"Python {python}, aarch64: not every dependency has a wheel\n{error}")
            return 1
        own = [name for name in wheels if "aarch64" in name]
        print(f"Python {python}, aarch64: {len(wheels)} wheels, {len(own)} of them for this processor")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
