"""web/net/messages.js and docs/protocol.md are what tools/generate_protocol.py makes of the messages."""

import importlib.util
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
_SPEC = importlib.util.spec_from_file_location("generate_protocol", ROOT / "tools" / "generate_protocol.py")
assert _SPEC is not None and _SPEC.loader is not None
generate_protocol = importlib.util.module_from_spec(_SPEC)
_SPEC.loader.exec_module(generate_protocol)

HINT = "run .venv/bin/python tools/generate_protocol.py"


def test_messages_of_the_page_are_current():
    assert generate_protocol.JS.read_text(encoding="utf-8") == generate_protocol.render_js(), HINT


def test_protocol_page_is_current():
    present = generate_protocol.PAGE.read_text(encoding="utf-8")
    assert present == generate_protocol.render_page(present), HINT


@pytest.mark.parametrize("model", [*generate_protocol.FROM_PAGE, *generate_protocol.FROM_SERVER])
def test_every_message_is_told_to_the_page_with_its_type(model):
    kind = generate_protocol.type_of(model)
    script = generate_protocol.render_js()
    assert f"@typedef {{object}} {model.__name__}\n" in script
    assert f'@property {{"{kind}"}} type' in script
    assert f"### {kind}\n" in generate_protocol.PAGE.read_text(encoding="utf-8")
