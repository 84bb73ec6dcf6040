"""An off-screen OpenGL context without a window: EGL, else OSMesa, through ctypes (no PyOpenGL, no X).

Order: system EGL (`libegl1 libgl1-mesa-dri`), system OSMesa (`libosmesa6`), and the OSMesa inside the PyPI
wheel `lavavu-osmesa`. A context belongs to the thread that made it.
"""

import ctypes
import os
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any, Protocol

from tapreach.errors import SetupError

# Before OpenGL is loaded: one drawing thread leaves a core to physics and server, at the same picture rate.
os.environ.setdefault("LP_NUM_THREADS", "1")

INSTALL_HINT = (
    "no off-screen OpenGL on this machine. Install one of:\n"
    "  sudo apt install --no-install-recommends libegl1 libgl1-mesa-dri\n"
    "  sudo apt install --no-install-recommends libosmesa6\n"
    "  pip install --no-deps lavavu-osmesa        (x86_64, Python 3.10 to 3.13; needs no system package)"
)


class GLContext(Protocol):
    """A current OpenGL context."""

    name: str

    def free(self) -> None:
        """Let go of the context, in the thread that made it."""
        ...


def create_context(choice: str = "auto") -> GLContext:
    """Make a context and make it current in this thread.

    choice: "auto", or one of "egl", "osmesa", "osmesa-wheel". Raises SetupError with the install lines and
    what each of the tried ways said.
    """
    ways: dict[str, Callable[[], GLContext]] = {
        "egl": EglContext,
        "osmesa": SystemOSMesa,
        "osmesa-wheel": WheelOSMesa,
    }
    tried = []
    for name, way in ways.items():
        if choice not in ("auto", name):
            continue
        try:
            return way()
        except (OSError, RuntimeError, AttributeError) as error:
            tried.append(f"  {name}: {error}")
    if not tried:
        raise SetupError(f"no way {choice!r} to OpenGL; known: auto, {', '.join(ways)}")
    raise SetupError("\n".join([INSTALL_HINT, "Tried:", *tried]))


class EglContext:
    """System EGL: a GPU's driver where there is one, else Mesa on the CPU."""

    name = "egl"
    _SURFACELESS, _NO_CONFIG = 0x31DD, None
    _CONFIG = (0x3033, 0x0001, 0x3040, 0x0008, 0x3024, 8, 0x3023, 8, 0x3022, 8, 0x3025, 24, 0x3038)

    def __init__(self) -> None:
        self._egl = ctypes.CDLL("libEGL.so.1", mode=ctypes.RTLD_GLOBAL)
        pointer, integer = ctypes.c_void_p, ctypes.c_int
        for function, result, arguments in (
            ("eglGetProcAddress", pointer, [ctypes.c_char_p]),
            ("eglGetDisplay", pointer, [pointer]),
            ("eglInitialize", integer, [pointer, pointer, pointer]),
            ("eglChooseConfig", integer, [pointer, pointer, pointer, integer, pointer]),
            ("eglCreateContext", pointer, [pointer, pointer, pointer, pointer]),
            ("eglMakeCurrent", integer, [pointer, pointer, pointer, pointer]),
            ("eglDestroyContext", integer, [pointer, pointer]),
        ):
            found = getattr(self._egl, function)
            found.restype, found.argtypes = result, arguments
        self._egl.eglBindAPI(0x30A2)
        self._display, self._context = self._first_that_works()

    def free(self) -> None:
        """See GLContext."""
        if self._context:
            self._egl.eglMakeCurrent(self._display, None, None, None)
            self._egl.eglDestroyContext(self._display, self._context)
            self._context = None

    def _first_that_works(self) -> tuple[Any, Any]:
        for display in self._displays():
            if display and self._egl.eglInitialize(display, None, None):
                self._egl.eglBindAPI(0x30A2)
                context = self._context_on(display)
                if context and self._egl.eglMakeCurrent(display, None, None, context):
                    return display, context
        raise RuntimeError("EGL has no display that can draw off-screen (is libgl1-mesa-dri installed?)")

    def _displays(self) -> list[Any]:
        """Return device displays (GPUs first), Mesa's surfaceless display, and the default one."""
        get = self._extension("eglGetPlatformDisplayEXT", [ctypes.c_uint, ctypes.c_void_p, ctypes.c_void_p])
        query = self._extension("eglQueryDevicesEXT", [ctypes.c_int, ctypes.c_void_p, ctypes.c_void_p])
        displays = []
        if get and query:
            devices, count = (ctypes.c_void_p * 16)(), ctypes.c_int(0)
            query(16, devices, ctypes.byref(count))
            displays += [get(0x313F, devices[i], None) for i in range(count.value)]
        if get:
            displays.append(get(self._SURFACELESS, None, None))
        return [*displays, self._egl.eglGetDisplay(None)]

    def _extension(self, name: str, arguments: list[Any]) -> Any:
        address = self._egl.eglGetProcAddress(name.encode())
        return ctypes.CFUNCTYPE(ctypes.c_void_p, *arguments)(address) if address else None

    def _context_on(self, display: Any) -> Any:
        wanted = (ctypes.c_int * len(self._CONFIG))(*self._CONFIG)
        config, count = ctypes.c_void_p(), ctypes.c_int(0)
        if not self._egl.eglChooseConfig(display, wanted, ctypes.byref(config), 1, ctypes.byref(count)):
            return None
        return self._egl.eglCreateContext(display, config, None, None) if count.value else None


class _OSMesa:
    name = "osmesa"

    def __init__(self, library: ctypes.CDLL) -> None:
        self._library = library
        pointer, integer = ctypes.c_void_p, ctypes.c_int
        library.OSMesaCreateContextExt.restype = pointer
        library.OSMesaCreateContextExt.argtypes = [ctypes.c_uint, integer, integer, integer, pointer]
        library.OSMesaMakeCurrent.argtypes = [pointer, pointer, ctypes.c_uint, integer, integer]
        library.OSMesaDestroyContext.argtypes = [pointer]
        self._context = library.OSMesaCreateContextExt(0x1908, 24, 8, 0, None)
        # MuJoCo draws into a framebuffer of its own: this one only has to exist.
        self._pixels = (ctypes.c_ubyte * (64 * 64 * 4))()
        if not library.OSMesaMakeCurrent(self._context, self._pixels, 0x1401, 64, 64):
            raise RuntimeError("OSMesa made no context")

    def free(self) -> None:
        if self._context:
            self._library.OSMesaDestroyContext(self._context)
            self._context = None


class SystemOSMesa(_OSMesa):
    """Debian's libosmesa6."""

    def __init__(self) -> None:
        for name in ("libOSMesa.so.8", "libOSMesa.so.6"):
            try:
                library = ctypes.CDLL(name, mode=ctypes.RTLD_GLOBAL)
            except OSError:
                continue
            super().__init__(library)
            return
        raise RuntimeError("libOSMesa.so.8 is not installed")


class WheelOSMesa(_OSMesa):
    """The OSMesa that the wheel lavavu-osmesa carries."""

    name = "osmesa-wheel"

    def __init__(self) -> None:
        folders = [Path(entry or ".") / "lavavu_osmesa.libs" for entry in sys.path]
        folder = next((f for f in folders if f.is_dir()), None)
        if folder is None:
            raise RuntimeError("the Python package lavavu-osmesa is not installed")
        libraries = sorted(str(path) for path in folder.glob("*.so*"))
        _load_in_any_order([name for name in libraries if "OSMesa" not in name])
        super().__init__(ctypes.CDLL(next(n for n in libraries if "OSMesa" in n), mode=ctypes.RTLD_GLOBAL))


def _load_in_any_order(libraries: list[str]) -> None:
    """Load libraries that need one another and carry no path: retry until no more load."""
    for _ in range(len(libraries)):
        for name in list(libraries):
            try:
                ctypes.CDLL(name, mode=ctypes.RTLD_GLOBAL)
            except OSError:
                continue
            libraries.remove(name)
