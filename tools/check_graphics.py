"""Can this machine render off-screen? Exit 0 and name the library, or exit 1 and say what was tried.

Standard library only: runs with the system's Python before anything is installed.
"""

import ctypes
import importlib.util
import sys
from pathlib import Path

EGL_PLATFORM_SURFACELESS_MESA = 0x31DD
EGL_OPENGL_API = 0x30A2


def egl_works() -> bool:
    """True when EGL opens a display without a screen and offers desktop OpenGL."""
    try:
        egl = ctypes.CDLL("libEGL.so.1")
    except OSError:
        return False
    egl.eglGetPlatformDisplay.restype = ctypes.c_void_p
    egl.eglGetPlatformDisplay.argtypes = [ctypes.c_uint, ctypes.c_void_p, ctypes.c_void_p]
    egl.eglInitialize.argtypes = [ctypes.c_void_p, ctypes.c_void_p, ctypes.c_void_p]
    egl.eglBindAPI.argtypes = [ctypes.c_uint]
    display = egl.eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, None, None)
    return bool(display and egl.eglInitialize(display, None, None) and egl.eglBindAPI(EGL_OPENGL_API))


def system_osmesa_works() -> bool:
    """True when a system-wide OSMesa can be loaded."""
    for name in ("libOSMesa.so.8", "libOSMesa.so.6"):
        try:
            ctypes.CDLL(name)
        except OSError:
            continue
        return True
    return False


def wheel_osmesa_is_there() -> bool:
    """True when the lavavu-osmesa wheel is installed; its libraries are loaded by the simulator itself."""
    spec = importlib.util.find_spec("lavavu")
    if spec is None or spec.origin is None:
        return False
    libraries = Path(spec.origin).parents[1] / "lavavu_osmesa.libs"
    return any(libraries.glob("libOSMesa*"))


def main() -> int:
    """Print the first library that works; 1 when there is none."""
    for name, works in (
        ("EGL", egl_works),
        ("OSMesa", system_osmesa_works),
        ("OSMesa of lavavu-osmesa", wheel_osmesa_is_there),
    ):
        if works():
            print(name)
            return 0
    print("none of EGL, OSMesa, lavavu-osmesa can be used")
    return 1


if __name__ == "__main__":
    sys.exit(main())
