# shellcheck shell=sh
# The simulated camera renders off-screen: through Mesa's EGL, or through OSMesa out of a Python wheel.

wheel_renderer=lavavu-osmesa

can_render_with() { "$1" tools/check_graphics.py >/dev/null 2>&1; }

want_graphics_packages() {
  [ -e .venv/.graphics ] && return 0
  probe=.venv/bin/python
  [ -x "$probe" ] || probe=${python:-}
  [ -n "$probe" ] && can_render_with "$probe" && return 0
  want_package libegl1 libgl1-mesa-dri
}

ensure_graphics() {
  [ -e .venv/.graphics ] && return 0
  if ! can_render_with .venv/bin/python; then install_wheel_renderer; fi
  : >.venv/.graphics
}

# Only Mesa is used out of this wheel, hence --no-deps: its dependencies are a whole plotting stack.
install_wheel_renderer() {
  wheel_fits ||
    die "no off-screen renderer for the simulated camera." "Install Mesa's EGL, then run the same command again:" \
      "  $(missing_packages=' libegl1 libgl1-mesa-dri' by_hand_line)"
  say "Mesa's EGL is not installed, so the renderer comes from PyPI instead ($wheel_renderer, 84 MB)."
  pip_install --no-deps "$wheel_renderer"
  can_render_with .venv/bin/python ||
    die "$wheel_renderer is installed but does not render here." "Install Mesa's EGL instead:" \
      "  $(missing_packages=' libegl1 libgl1-mesa-dri' by_hand_line)"
}

# The wheel exists for 64-bit Intel and Python up to 3.13.
wheel_fits() {
  [ "$(uname -m)" = x86_64 ] && .venv/bin/python -c 'import sys; sys.exit(sys.version_info >= (3, 14))'
}
