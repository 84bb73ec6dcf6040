#!/bin/sh
# make test: install what the tests need, then run every check in order. Tests run only on code that passed the rest.
set -eu
cd "$(dirname "$0")/.."
. tools/lib/say.sh
. tools/lib/system_packages.sh
. tools/lib/python_env.sh
. tools/lib/graphics.sh
. tools/lib/browser.sh
. tools/lib/node_env.sh
. tools/lib/avr.sh
. tools/lib/camera.sh
. tools/lib/systemd.sh

prepare() {
  want_python_packages
  want_browser_package
  want_node_packages
  required=$missing_packages
  want_graphics_packages
  want_avr_packages
  want_camera_packages
  want_systemd_package
  install_packages || [ -z "$required" ] || explain_missing_packages
  ensure_venv
  ensure_package "[dev]"
  ensure_graphics
  ensure_browser
  ensure_node_modules
}

failed=""

# check NAME COMMAND...: runs it, says how long it took, notes a failure and goes on.
check() {
  name=$1
  shift
  step "$name"
  started=$(date +%s)
  "$@" || failed="$failed
$name:  $*"
  say "$name: $(($(date +%s) - started)) s"
}

check_code() {
  check "ruff format" .venv/bin/ruff format --check .
  check "ruff check" .venv/bin/ruff check --quiet .
  check "mypy" .venv/bin/mypy
  check "eslint" node_modules/.bin/eslint --max-warnings 0 --no-error-on-unmatched-pattern web
  check "tsc" node_modules/.bin/tsc
  [ -z "$failed" ] || die "these checks failed (their own words are above); each by itself:$failed"
}

prepare
check_code
[ -z "${TAPREACH_LINT_ONLY:-}" ] || exit 0
step "pytest"
exec .venv/bin/python -m pytest --durations=15 -rR "$@"
