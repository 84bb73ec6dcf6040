"""The one question the setup asks, at a real terminal."""

import errno
import os
import pty
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
ASK = '. tools/lib/say.sh; if confirm "Install with sudo?"; then echo went on; else echo left it; fi'


def answer_at_a_terminal(typed: str, **environment: str) -> str:
    """What the person sees after typing this."""
    ours, theirs = pty.openpty()
    inherited = {name: value for name, value in os.environ.items() if name not in {"CI", "TAPREACH_YES"}}
    with subprocess.Popen(
        ["/bin/sh", "-c", ASK], cwd=ROOT, env=inherited | environment, stdin=theirs, stdout=theirs
    ) as shell:
        os.close(theirs)
        os.write(ours, typed.encode())
        shell.wait(timeout=30)
    return read_to_the_end(ours)


def read_to_the_end(terminal: int) -> str:
    """Everything shown; it may arrive in pieces, and Linux ends a terminal without a writer with EIO."""
    seen = b""
    with os.fdopen(terminal, "rb", buffering=0) as screen:
        try:
            while piece := screen.read(4096):
                seen += piece
        except OSError as error:
            if error.errno != errno.EIO:
                raise
    return seen.decode()


@pytest.mark.parametrize("typed", ["\n", "y\n", "Yes\n"])
def test_question_answered_with_yes_goes_on(typed: str) -> None:
    assert "went on" in answer_at_a_terminal(typed)


@pytest.mark.parametrize("typed", ["n\n", "no\n", "what?\n"])
def test_question_answered_otherwise_leaves_it(typed: str) -> None:
    seen = answer_at_a_terminal(typed)
    assert "Install with sudo? [Y/n]" in seen
    assert "left it" in seen


def test_question_is_not_asked_in_ci() -> None:
    seen = answer_at_a_terminal("y\n", CI="true")
    assert "[Y/n]" not in seen
    assert "left it" in seen


def test_question_is_not_asked_when_answered_beforehand() -> None:
    seen = answer_at_a_terminal("", TAPREACH_YES="1")
    assert "[Y/n]" not in seen
    assert "went on" in seen
