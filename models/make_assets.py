"""Make every texture and mesh of the simulation, the same each time: `python models/make_assets.py [FOLDER]`.

Everything is drawn here, so there is no licence to carry. The results are kept in `models/assets`; a
test makes them anew and compares. Needs numpy and Pillow.
"""

import sys
from pathlib import Path

from asset_drawing import save_texture
from asset_labels import LABELS
from asset_meshes import MESHES, write_box, write_obj
from asset_surfaces import SURFACES


def make_assets(folder: Path) -> None:
    """Write all textures (PNG) and meshes (OBJ) into `folder`."""
    folder.mkdir(parents=True, exist_ok=True)
    for name, (draw, colours) in {**SURFACES, **LABELS}.items():
        save_texture(folder / f"{name}.png", draw(), colours)
    for name, profile in MESHES.items():
        write_obj(folder / f"{name}.obj", profile)
    write_box(folder / "box.obj")


if __name__ == "__main__":
    make_assets(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parent / "assets")
