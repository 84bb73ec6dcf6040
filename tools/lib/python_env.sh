# shellcheck shell=sh
# A Python of 3.11 or later, the virtual environment, and the package in it.

python_is_new_enough() { "$1" -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null; }

# Sets $python, or leaves it empty when no usable one is installed. TAPREACH_PYTHON goes before all others.
find_python() {
  python=""
  for candidate in ${TAPREACH_PYTHON:-} python3 python3.13 python3.12 python3.11 python3.14; do
    if has "$candidate" && python_is_new_enough "$candidate"; then
      python=$(command -v "$candidate")
      return 0
    fi
  done
}

# Notes the packages without which no virtual environment can be made.
want_python_packages() {
  [ -x .venv/bin/python ] && return 0
  find_python
  if [ -z "$python" ]; then
    if has python3; then
      die "Python 3.11 or later is needed; this machine has $(python3 --version 2>&1)." \
        "Install a newer one (Debian 12, Debian 13 and Ubuntu 24.04 have it), or name one:" \
        "TAPREACH_PYTHON=/path/to/python3.12 make run"
    fi
    want_package python3 python3-venv
  elif ! "$python" -c 'import ensurepip, venv' 2>/dev/null; then
    want_package "$(venv_package)"
  fi
}

# Debian ships venv for each Python apart; python3-venv is the one of /usr/bin/python3.
venv_package() {
  case "$(basename "$python")" in
    python3) echo python3-venv ;;
    *) echo "$(basename "$python")-venv" ;;
  esac
}

ensure_venv() {
  [ -x .venv/bin/python ] && .venv/bin/python -c 'import pip' 2>/dev/null && return 0
  find_python
  require_space 1500
  step "Creating the virtual environment .venv with $("$python" --version)"
  "$python" -m venv --clear .venv ||
    die "the virtual environment could not be made with $python." \
      "Install its venv module ($(venv_package) on Debian and Ubuntu), delete .venv and try again."
}

# A stamp says what was installed, from which pyproject and where; any change installs again.
install_key() { printf '%s %s %s' "$1" "$(cksum <pyproject.toml)" "$PWD"; }

is_installed() { [ "$(cat ".venv/.installed$1" 2>/dev/null)" = "$(install_key "$1")" ]; }

# ensure_package EXTRAS: "" for a user, "[dev]" for the tests (which contains the first).
ensure_package() {
  is_installed "$1" && return 0
  [ -z "$1" ] && is_installed "[dev]" && return 0
  require_space 1500
  step "Installing Tapreach and the libraries it uses into .venv (once; about 120 MB to download)"
  pip_install --editable ".$1"
  install_key "$1" >".venv/.installed$1"
}

# pip shows bars to a person and keeps quiet in a log.
pip_install() {
  quiet=--quiet
  is_interactive && quiet=--progress-bar=on
  .venv/bin/python -m pip install --disable-pip-version-check --retries 2 "$quiet" "$@" || explain_pip_failure
}

explain_pip_failure() {
  if [ "$(free_mb .)" -lt 300 ] || [ "$(free_mb "${TMPDIR:-/tmp}")" -lt 300 ]; then
    die "the disk is full: $(free_mb .) MB free here, $(free_mb "${TMPDIR:-/tmp}") MB in ${TMPDIR:-/tmp}." \
      "Free about 1.5 GB (or set TMPDIR to a larger disk), then run the same command again."
  fi
  die "pip could not install the libraries; its own words are above." \
    "Most often there is no network, or a proxy is needed (set HTTPS_PROXY)." \
    "Then run the same command again; what was already fetched is kept."
}

require_space() {
  [ "$(free_mb .)" -ge "$1" ] ||
    die "only $(free_mb .) MB are free on this disk and about $1 MB are needed." \
      "Free some space, then run the same command again."
}
