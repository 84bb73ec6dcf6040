#!/bin/sh
# make run: install whatever is missing, then start the simulated rover and the operator page.
set -eu
cd "$(dirname "$0")/.."
. tools/lib/say.sh
. tools/lib/system_packages.sh
. tools/lib/python_env.sh
. tools/lib/graphics.sh

prepare() {
  want_python_packages
  needed=$missing_packages
  want_graphics_packages
  if ! install_packages && [ -n "$needed" ]; then
    die "system packages are missing." "Install them, then run the same command again:" "  $(by_hand_line)"
  fi
  ensure_venv
  ensure_package ""
  ensure_graphics
}

prepare
exec .venv/bin/tapreach run "$@"
