# shellcheck shell=sh
# Plain lines for a person: what is being done, what went wrong, what to do about it.

say() { printf '%s\n' "$*"; }

step() { printf '\n==> %s\n' "$*"; }

# die MESSAGE ADVICE...: the last thing a failing step does.
die() {
  printf '\nStopped: %s\n' "$1" >&2
  shift
  for line in "$@"; do printf '  %s\n' "$line" >&2; done
  exit 1
}

# May we ask the person at the keyboard?
is_interactive() { [ -t 0 ] && [ -t 1 ] && [ -z "${CI:-}" ]; }

# confirm QUESTION: yes by default; TAPREACH_YES=1 answers yes beforehand; nobody there means no.
confirm() {
  [ "${TAPREACH_YES:-}" = 1 ] && return 0
  is_interactive || return 1
  printf '%s [Y/n] ' "$1"
  read -r answer || return 1
  case "$answer" in '' | [Yy]*) return 0 ;; *) return 1 ;; esac
}

has() { command -v "$1" >/dev/null 2>&1; }

# free_mb FOLDER: megabytes still free on its disk.
free_mb() { df -Pm "$1" | awk 'NR == 2 { print $4 }'; }
