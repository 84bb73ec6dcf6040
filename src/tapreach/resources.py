"""Where the files that are not Python lie: web page, scenes, robots, models."""

from importlib.resources import files
from pathlib import Path

from tapreach.errors import SetupError

_CHECKOUT = Path(__file__).resolve().parents[2]


def resource_path(name: str) -> Path:
    """Return the folder `name` ("web", "scenes", "robots", "models", "firmware") of a wheel or a checkout.

    Raises SetupError where the installation is incomplete.
    """
    packaged = Path(str(files("tapreach"))) / "_data" / name
    for folder in (packaged, _CHECKOUT / name):
        if folder.is_dir():
            return folder
    raise SetupError(f"the folder {name!r} is missing from this installation; reinstall tapreach")
