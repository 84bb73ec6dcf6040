import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from tapreach.resources import resource_path

KEPT = resource_path("models") / "assets"


@pytest.fixture(scope="module")
def fresh(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("assets")
    script = resource_path("models") / "make_assets.py"
    subprocess.run([sys.executable, str(script), str(folder)], check=True, timeout=120)
    return folder


def test_kept_assets_are_what_the_script_makes(fresh: Path) -> None:
    names = sorted(path.name for path in fresh.iterdir())
    assert names == sorted(path.name for path in KEPT.iterdir())
    for name in names:
        if name.endswith(".obj"):
            assert (fresh / name).read_text() == (KEPT / name).read_text(), name
        else:  # another version of Pillow may pick another palette, not another picture
            made, kept = (np.asarray(Image.open(f / name).convert("RGB"), float) for f in (fresh, KEPT))
            assert made.shape == kept.shape, name
            assert np.abs(made - kept).mean() < 2.0, name


def test_assets_stay_small() -> None:
    assert sum(path.stat().st_size for path in KEPT.iterdir()) < 4_000_000


@pytest.mark.parametrize("path", sorted(KEPT.glob("*.obj")), ids=lambda path: path.name)
def test_mesh_is_closed_or_open_above_and_its_normals_are_unit(path: Path) -> None:
    rows = [line.split() for line in path.read_text().splitlines()]
    normals = np.array([row[1:] for row in rows if row[0] == "vn"], dtype=float)
    assert np.abs(np.linalg.norm(normals, axis=1) - 1.0).max() < 1e-3
    points = np.array([row[1:] for row in rows if row[0] == "v"], dtype=float)
    faces = (
        np.array([[part.split("/")[0] for part in row[1:]] for row in rows if row[0] == "f"], dtype=int) - 1
    )
    a, b, c = (points[faces[:, i]] for i in range(3))
    facing = np.cross(b - a, c - a)
    agree = np.einsum("ij,ij->i", facing, normals[faces[:, 0]])
    assert (agree > -1e-9).all(), "the faces look outward, as the normals do"
