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
  required=$missing_packages
  want_graphics_packages # wanted, not required: a wheel can take their place
  install_packages || [ -z "$required" ] || explain_missing_packages
  ensure_venv
  ensure_package ""
  ensure_graphics
}

prepare
exec .venv/bin/tapreach run "$@"
