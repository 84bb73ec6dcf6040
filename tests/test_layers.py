"""Imports go down only: the table of rows as data, held against every import in the package.

docs/architecture.md shows the same table to readers; a test here keeps the two in step.
"""

import ast
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
PACKAGE = ROOT / "src" / "tapreach"

ROWS: dict[int, tuple[str, ...]] = {
    7: ("cli",),
    6: ("bench",),
    5: ("server",),
    4: ("tasks",),
    3: ("control", "drivers", "recording", "client"),
    2: ("robot", "estimation", "vision"),
    1: ("geometry",),
    0: ("errors", "resources"),
}
ROW_OF = {part: row for row, parts in ROWS.items() for part in parts}

FOR_ALL = {"errors"}  # imports nothing, so even its neighbour in row 0 may import it
GROUND_TRUTH = "tapreach.drivers.sim.truth"
MAY_KNOW_TRUTH = {"bench"}
# The simulated world itself: it makes the truth and sends it, unread, to a host that asked for it.
TELLS_TRUTH = {f"tapreach.drivers.sim.{name}" for name in ("child", "child_physics", "inline")}
MAY_NAME_DRIVERS = {"cli", "bench", "drivers"}

# Third-party modules that only these parts may import. "*" would be everybody, and needs no entry.
ONLY_IN: dict[str, set[str]] = {
    "mujoco": {"drivers"},
    "starlette": {"server", "cli", "bench"},
    "uvicorn": {"server", "cli", "bench"},
    "typer": {"cli"},
    "cv2": {"vision", "drivers", "recording", "server", "bench", "cli"},
    "playwright": {"bench"},
    "websockets": {"client", "bench"},
}
# Parts that may import nothing from outside but these (and the standard library).
NOTHING_BUT: dict[str, set[str]] = {
    "geometry": {"numpy", "scipy"},
    "errors": set(),
    "resources": set(),
}
# Parts that may use nothing of the package but these: a client knows the robot by its messages alone.
USES_ONLY: dict[str, tuple[str, ...]] = {
    "client": ("errors", "geometry", "robot.clock", "vision.image_io"),
}


@dataclass(frozen=True)
class Import:
    """One import statement: who imports which absolute module name, and where."""

    importer: str
    imported: str
    where: str


def module_name(path: Path, package: Path) -> str:
    parts = path.relative_to(package.parent).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


def imported_names(tree: ast.AST, importer: str, is_package: bool) -> Iterator[tuple[str, int]]:
    """All absolute module names that the tree imports, also inside functions and under TYPE_CHECKING."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from ((alias.name, node.lineno) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = importer.split(".")
            if node.level:
                base = base[: len(base) - node.level + (1 if is_package else 0)]
            origin = ".".join([*(base if node.level else []), *([node.module] if node.module else [])])
            yield from ((f"{origin}.{alias.name}", node.lineno) for alias in node.names)


def imports_of(package: Path) -> list[Import]:
    found = []
    for path in sorted(package.rglob("*.py")):
        importer = module_name(path, package)
        tree = ast.parse(path.read_text(encoding="utf-8"))
        for imported, line in imported_names(tree, importer, path.name == "__init__.py"):
            found.append(Import(importer, imported, f"{path.relative_to(package.parent)}:{line}"))
    return found


def part_of(module: str) -> str | None:
    """`tapreach.drivers.sim.world` belongs to `drivers`; the package's own front page to none."""
    pieces = module.split(".")
    return pieces[1] if pieces[0] == "tapreach" and len(pieces) > 1 else None


def complaint(item: Import) -> str | None:
    """Why this import is against the rows, or None."""
    importer, imported = part_of(item.importer), part_of(item.imported)
    if importer is None:
        return None
    if item.imported.split(".")[0] != "tapreach":
        return outside_complaint(importer, item.imported.split(".")[0])
    if imported not in ROW_OF:
        return f"{importer} imports the package's front page; name the module it comes from"
    if imported == importer:
        return truth_complaint(importer, item)
    if ROW_OF[imported] >= ROW_OF[importer] and imported not in FOR_ALL:
        return f"{importer} (row {ROW_OF[importer]}) imports {imported} (row {ROW_OF[imported]})"
    if not is_among(item.imported, USES_ONLY.get(importer)):
        return f"{importer} imports {item.imported}; of the package it may use {USES_ONLY[importer]} alone"
    if imported == "drivers" and importer not in MAY_NAME_DRIVERS:
        return f"{importer} names drivers; only {sorted(MAY_NAME_DRIVERS)} may"
    return truth_complaint(importer, item)


def is_among(module: str, allowed: tuple[str, ...] | None) -> bool:
    """Whether the module is one of these or lies below one; for None everything is."""
    return allowed is None or any(f"{module}.".startswith(f"tapreach.{name}.") for name in allowed)


def truth_complaint(importer: str, item: Import) -> str | None:
    names_truth = item.imported == GROUND_TRUTH or item.imported.startswith(GROUND_TRUTH + ".")
    if names_truth and importer not in MAY_KNOW_TRUTH and item.importer not in TELLS_TRUTH:
        return f"{importer} reads the simulation's ground truth"
    return None


def outside_complaint(importer: str, top: str) -> str | None:
    if top in ONLY_IN and importer not in ONLY_IN[top]:
        return f"{importer} imports {top}; only {sorted(ONLY_IN[top])} may"
    if importer in NOTHING_BUT and top not in sys.stdlib_module_names and top not in NOTHING_BUT[importer]:
        return f"{importer} imports {top}; it may use {sorted(NOTHING_BUT[importer])} and nothing else"
    return None


def complaints(package: Path) -> list[str]:
    return [f"{item.where}: {why}" for item in imports_of(package) if (why := complaint(item))]


def test_imports_of_the_package_go_down_only() -> None:
    assert complaints(PACKAGE) == []


def test_nobody_asks_the_simulation_for_the_truth() -> None:
    outside = [path for path in PACKAGE.rglob("*.py") if not {"bench", "sim"} & set(path.parts)]
    asks = ("ask_truth", "tells_truth", "truth_json")
    assert [str(p) for p in outside if any(word in p.read_text(encoding="utf-8") for word in asks)] == []


def test_every_part_of_the_package_stands_in_a_row() -> None:
    parts = {
        path.stem for path in PACKAGE.iterdir() if path.suffix == ".py" or (path / "__init__.py").exists()
    }
    assert parts - {"__init__", "__main__", "py"} == set(ROW_OF)


def test_architecture_page_shows_the_same_rows() -> None:
    shown = {}
    for line in (ROOT / "docs" / "architecture.md").read_text(encoding="utf-8").splitlines():
        cells = [cell.strip(" `") for cell in line.strip("|").split("|")]
        if line.startswith("|") and cells[0].isdigit():
            shown[int(cells[0])] = tuple(name.strip(" `") for name in cells[1].split(","))
    assert shown == ROWS


@pytest.mark.parametrize(
    ("importer", "line", "reason"),
    [
        (
            "geometry/ray.py",
            "from tapreach.tasks.locate import Locate",
            "geometry (row 1) imports tasks (row 4)",
        ),
        ("vision/patch.py", "import tapreach.estimation.bound", "vision (row 2) imports estimation (row 2)"),
        (
            "vision/patch.py",
            "def lazy():\n    from tapreach.robot import clock",
            "vision (row 2) imports robot",
        ),
        ("robot/clock.py", "from ..control import gate", "robot (row 2) imports control (row 3)"),
        ("robot/__init__.py", "from ..server import app", "robot (row 2) imports server (row 5)"),
        ("tasks/locate.py", "from tapreach import estimate_point", "the package's front page"),
        ("server/app.py", "from tapreach.drivers.registry import open_robot", "server names drivers"),
        ("drivers/sim/robot.py", "from tapreach.drivers.sim import truth", "ground truth"),
        ("drivers/sim/robot.py", "from .truth import read_truth", "ground truth"),
        ("estimation/bound.py", "import cv2", "estimation imports cv2"),
        ("estimation/bound.py", "import mujoco", "estimation imports mujoco"),
        ("geometry/ray.py", "import pydantic", "geometry imports pydantic"),
        ("client/news.py", "from tapreach.server import messages", "client (row 3) imports server (row 5)"),
        ("client/sync.py", "from tapreach.robot.clocks import x", "client imports tapreach.robot.clocks"),
        ("cli/fetch.py", "import websockets", "cli imports websockets"),
    ],
)
def test_violating_import_is_named(tmp_path: Path, importer: str, line: str, reason: str) -> None:
    path = tmp_path / "tapreach" / importer
    path.parent.mkdir(parents=True)
    path.write_text(line, encoding="utf-8")
    (found,) = complaints(tmp_path / "tapreach")
    assert found.startswith(f"tapreach/{importer}:")
    assert reason in found


def test_downward_import_is_allowed(tmp_path: Path) -> None:
    path = tmp_path / "tapreach" / "bench" / "locate.py"
    path.parent.mkdir(parents=True)
    path.write_text(
        "from tapreach.drivers.sim.truth import read\nfrom tapreach import errors\n", encoding="utf-8"
    )
    (tmp_path / "tapreach" / "__init__.py").write_text("from tapreach.geometry.camera import Camera\n")
    assert complaints(tmp_path / "tapreach") == []
