"""Does the system bring a library that renders off-screen? Exit 0 and name it, or exit 1.

Standard library only: runs with the system's Python before anything is installed.
"""

import ctypes
import sys

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


def main() -> int:
    """Print the first library that works; 1 when there is none."""
    for name, works in (("EGL", egl_works), ("OSMesa", system_osmesa_works)):
        if works():
            print(name)
            return 0
    print("neither EGL nor OSMesa can be used")
    return 1


if __name__ == "__main__":
    sys.exit(main())
