"""Settings shared by all tests."""

import os
from pathlib import Path

import pytest
from hypothesis import settings

# Two busy cores make single examples slow now and then; pytest-timeout bounds the whole test instead.
# The gate judges a change by the same examples each time; at a desk every run searches further.
settings.register_profile("tapreach", deadline=None, derandomize=bool(os.environ.get("CI")), print_blob=True)
settings.load_profile("tapreach")

HERE = Path(__file__).parent
_REAL_TIME = ("bench", "cli", "client", "drivers/camera", "scenarios", "server", "web")
REAL_CLOCK = [HERE / part for part in _REAL_TIME]
"""Tests of real browsers, sockets and processes. On a busy machine the safety limits under test (200 ms of
silence stop the robot) rightly trip, so that one failure says little; two in a row do.
"""


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Under CI, tests against the real clock get a second try; the summary names each that needed it."""
    if not os.environ.get("CI"):
        return
    for item in items:
        if any(part in item.path.parents for part in REAL_CLOCK):
            item.add_marker(pytest.mark.flaky(reruns=1))
