# shellcheck shell=sh
# The simulated camera renders off-screen: through Mesa's EGL, or through OSMesa out of a Python wheel.

wheel_renderer=lavavu-osmesa

graphics_packages="libegl1 libgl1-mesa-dri"

# Before anything is installed: does the system bring a library that renders without a screen?
system_renders() { "$1" tools/check_graphics.py >/dev/null 2>&1; }

# Afterwards: does the simulated camera itself get a context?
simulator_renders() { .venv/bin/python -c 'from tapreach.drivers.sim.gl import create_context; create_context().free()'; }

want_graphics_packages() {
  [ -e .venv/.graphics ] && return 0
  probe=.venv/bin/python
  [ -x "$probe" ] || probe=${python:-}
  [ -n "$probe" ] && system_renders "$probe" && return 0
  # shellcheck disable=SC2086  # a list of words
  want_package $graphics_packages
}

ensure_graphics() {
  [ -e .venv/.graphics ] && return 0
  simulator_renders 2>/dev/null || install_wheel_renderer
  : >.venv/.graphics
}

graphics_by_hand() {
  die "$1" "Install Mesa's EGL, then run the same command again:" \
    "  $(missing_packages=" $graphics_packages" by_hand_line)"
}

# Only Mesa is used out of this wheel, hence --no-deps: its dependencies are a whole plotting stack.
install_wheel_renderer() {
  wheel_fits || graphics_by_hand "no off-screen renderer for the simulated camera."
  step "Mesa's EGL is not installed; taking the renderer of $wheel_renderer from PyPI instead (84 MB)"
  pip_install --no-deps "$wheel_renderer"
  simulator_renders || graphics_by_hand "$wheel_renderer is installed but does not render here."
}

# The wheel exists for 64-bit Intel and Python up to 3.13.
wheel_fits() {
  [ "$(uname -m)" = x86_64 ] && .venv/bin/python -c 'import sys; sys.exit(sys.version_info >= (3, 14))'
}
