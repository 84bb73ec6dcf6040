"""docs/fetch-states.md is what tools/generate_fetch_states.py makes of the table."""

import importlib.util
from pathlib import Path

from tapreach.tasks.fetch.states import STATES

ROOT = Path(__file__).resolve().parents[3]
_SPEC = importlib.util.spec_from_file_location(
    "generate_fetch_states", ROOT / "tools" / "generate_fetch_states.py"
)
assert _SPEC is not None and _SPEC.loader is not None
generate_fetch_states = importlib.util.module_from_spec(_SPEC)
_SPEC.loader.exec_module(generate_fetch_states)


def test_the_page_is_current() -> None:
    present = generate_fetch_states.PAGE.read_text(encoding="utf-8")
    assert present == generate_fetch_states.render(), "run .venv/bin/python tools/generate_fetch_states.py"


def test_the_picture_has_an_arrow_for_every_way_a_state_can_end() -> None:
    picture = generate_fetch_states.picture()
    for phase, state in STATES.items():
        for after in state.after.values():
            assert f"{phase} --> {after}:" in picture
