"""Every dependency has a wheel for a Raspberry Pi: nothing is compiled there."""

import importlib.util
import os
from pathlib import Path

import pytest

PATH = Path(__file__).resolve().parents[2] / "tools" / "check_aarch64.py"
_SPEC = importlib.util.spec_from_file_location("check_aarch64", PATH)
checker = importlib.util.module_from_spec(_SPEC)
_SPEC.loader.exec_module(checker)
NO_NETWORK = ("connection", "resolve host", "timed out", "network", "proxy")


def resolved(requirements, python):
    try:
        return checker.resolve(requirements, python)
    except RuntimeError as error:
        if not os.environ.get("CI") and any(word in str(error).lower() for word in NO_NETWORK):
            pytest.skip("needs a package index: pip did not reach one")
        raise


@pytest.mark.parametrize("python", checker.PYTHONS)
def test_every_dependency_has_a_wheel_for_aarch64(python):
    wheels = resolved(checker.dependencies(), python)
    assert [name for name in wheels if not name.endswith(("aarch64.whl", "none-any.whl"))] == []
    own = " ".join(name for name in wheels if "aarch64" in name)
    for name in ("numpy", "scipy", "opencv_python_headless", "mujoco_core", "av", "uvloop", "pydantic_core"):
        assert f"{name}-" in own


def test_missing_wheel_is_told():
    with pytest.raises(RuntimeError, match="gtsam"):
        resolved(["gtsam==4.2"], "3.13")
