# shellcheck shell=sh
# Debian and Ubuntu packages: collected first, then asked for once.

missing_packages=""

want_package() { missing_packages="$missing_packages $*"; }

apt_line() { printf '%sapt-get update && %sapt-get install -y --no-install-recommends%s' "$1" "$1" "$missing_packages"; }

# The line that a person types to do it by hand.
by_hand_line() {
  if [ "$(id -u)" = 0 ]; then apt_line ""; elif has sudo; then apt_line "sudo "; else printf "su -c '%s'" "$(apt_line "")"; fi
}

explain_missing_packages() {
  die "system packages are missing." "Install them, then run the same command again:" "  $(by_hand_line)"
}

# Returns 0 when everything collected is installed; 1 when it may not or cannot be.
install_packages() {
  [ -n "$missing_packages" ] || return 0
  has apt-get || return 1
  if [ "$(id -u)" = 0 ]; then
    step "Installing system packages:$missing_packages"
    run_apt ""
  elif has sudo && confirm "System packages are missing:$missing_packages. Install them with sudo?"; then
    step "Installing system packages:$missing_packages (sudo may ask for your password)"
    run_apt sudo
  else
    return 1
  fi
}

# `env` carries the answer to questions through sudo; the package lists may be empty or old on a fresh machine.
# shellcheck disable=SC2086  # $1 and $missing_packages are lists of words
run_apt() {
  quietly $1 env DEBIAN_FRONTEND=noninteractive apt-get update &&
    quietly $1 env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends $missing_packages &&
    missing_packages=""
}

# A person sees apt's bars; a log gets its words only when it fails.
quietly() {
  if is_interactive; then
    "$@"
    return
  fi
  words=$(mktemp)
  if "$@" >"$words" 2>&1 </dev/null; then
    rm "$words"
  else
    cat "$words" >&2
    rm "$words"
    return 1
  fi
}
