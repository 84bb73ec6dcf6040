#!/bin/sh
# make test: install what the tests need, then run every check in order; the first failure stops.
set -eu
cd "$(dirname "$0")/.."
. tools/lib/say.sh
. tools/lib/system_packages.sh
. tools/lib/python_env.sh
. tools/lib/graphics.sh
. tools/lib/browser.sh
. tools/lib/node_env.sh

prepare() {
  want_python_packages
  want_graphics_packages
  want_browser_package
  want_node_packages
  install_packages ||
    die "system packages are missing." "Install them, then run the same command again:" "  $(by_hand_line)"
  ensure_venv
  ensure_package "[dev]"
  ensure_graphics
  ensure_browser
  ensure_node_modules
}

# check NAME COMMAND...: runs it, says how long it took.
check() {
  name=$1
  shift
  step "$name"
  started=$(date +%s)
  "$@" || die "$name failed (its own words are above)." "By itself:  $*"
  say "$name: $(($(date +%s) - started)) s"
}

check_code() {
  check "ruff format" .venv/bin/ruff format --check --quiet --diff .
  check "ruff check" .venv/bin/ruff check --quiet .
  check "mypy" .venv/bin/mypy
  check "eslint" node_modules/.bin/eslint --max-warnings 0 --no-error-on-unmatched-pattern web
  check "tsc" node_modules/.bin/tsc
}

prepare
check_code
[ -z "${TAPREACH_LINT_ONLY:-}" ] || exit 0
step "pytest"
exec .venv/bin/python -m pytest --durations=15 "$@"
