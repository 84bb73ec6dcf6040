"""Write docs/fetch-states.md, the picture and the table of the states of fetching, from
src/tapreach/tasks/fetch/states.py (run: .venv/bin/python tools/generate_fetch_states.py).
"""

from pathlib import Path

from tapreach.tasks.fetch.states import ATTEMPTS, FIRST, STATES, Outcome, Phase, is_end

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs" / "fetch-states.md"

INTRO = f"""\
# The states of fetching

Made by `tools/generate_fetch_states.py` from `src/tapreach/tasks/fetch/states.py`; do not edit by hand.

The claw closes {ATTEMPTS} times at most. A stop, a touch of any drive control, or a lost operator ends every
state at once; the table says in which condition the robot is then left, and where fetching goes on when it is
asked to.
"""


def picture() -> str:
    """Return the states as a Mermaid diagram."""
    lines = ["```mermaid", "stateDiagram-v2", f"    [*] --> {FIRST}"]
    for phase, state in STATES.items():
        lines += [f"    {phase} --> {after}: {words(outcome)}" for outcome, after in state.after.items()]
    lines += [f"    {phase} --> [*]" for phase in STATES if is_end(phase)]
    return "\n".join([*lines, "```"])


def table() -> str:
    """Return the states as a table."""
    rows = ["| state | what the robot does | if stopped here | goes on at |", "|---|---|---|---|"]
    for phase, state in STATES.items():
        goes_on = state.resumes_at or ("" if is_end(phase) else phase)
        rows.append(f"| `{phase}` | {state.does} | {state.if_stopped} | {code(goes_on)} |")
    return "\n".join(rows)


def words(outcome: Outcome) -> str:
    """Return an outcome as it stands at an arrow."""
    return outcome.replace("_", " ")


def code(phase: Phase | str) -> str:
    """Return a state's name in code type, '' for none."""
    return f"`{phase}`" if phase else ""


def render() -> str:
    """Return the whole page."""
    return f"{INTRO}\n{picture()}\n\n{table()}\n"


if __name__ == "__main__":
    PAGE.write_text(render(), encoding="utf-8")
    print(f"wrote {PAGE.relative_to(ROOT)}")
