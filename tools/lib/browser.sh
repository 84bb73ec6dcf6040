# shellcheck shell=sh
# The page's tests drive a real Chromium of this system; nothing ever downloads a browser.

# Ubuntu's chromium-browser is a stub that only installs a snap: it answers no --version without one.
is_browser() { has "$1" && "$1" --version >/dev/null 2>&1; }

# Sets $chromium, empty when none is installed. TAPREACH_CHROMIUM goes before all others.
find_chromium() {
  chromium=""
  if [ -n "${TAPREACH_CHROMIUM:-}" ]; then
    is_browser "$TAPREACH_CHROMIUM" || die "TAPREACH_CHROMIUM=$TAPREACH_CHROMIUM is not a browser that runs."
    chromium=$TAPREACH_CHROMIUM
    return 0
  fi
  for candidate in chromium google-chrome google-chrome-stable chromium-browser; do
    if is_browser "$candidate"; then
      chromium=$(command -v "$candidate")
      return 0
    fi
  done
}

is_ubuntu() { grep -qs '^ID=ubuntu' /etc/os-release; }

want_browser_package() {
  find_chromium
  [ -n "$chromium" ] || is_ubuntu || want_package chromium
}

ensure_browser() {
  find_chromium
  if [ -z "$chromium" ] && is_ubuntu; then
    die "the page's tests need Chromium, and Ubuntu has it only as a snap." \
      "Run:  sudo snap install chromium    (or install Google Chrome)" \
      "or name one:  TAPREACH_CHROMIUM=/path/to/chrome make test"
  fi
  [ -n "$chromium" ] || die "the page's tests need Chromium." "Install it, or name one:" \
    "  TAPREACH_CHROMIUM=/path/to/chrome make test"
  TAPREACH_CHROMIUM=$chromium
  export TAPREACH_CHROMIUM
}
