# shellcheck shell=sh
# eslint and tsc check web/; the page itself needs neither Node nor a build.

want_node_packages() {
  has node || want_package nodejs
  has npm || want_package npm
}

node_is_new_enough() {
  node -e 'const [a, b] = process.versions.node.split(".").map(Number); process.exit(a > 18 || (a === 18 && b >= 18) ? 0 : 1)'
}

node_key() { cat package.json package-lock.json | cksum; }

ensure_node_modules() {
  node_is_new_enough || die "Node 18.18 or later is needed to check web/; this machine has $(node --version)."
  [ "$(cat node_modules/.installed 2>/dev/null)" = "$(node_key)" ] && return 0
  step "Installing eslint and tsc into node_modules (once)"
  npm ci --no-audit --no-fund --loglevel=error ||
    die "npm could not install the checkers; its own words are above." \
      "Most often there is no network, or a proxy is needed. Then run the same command again."
  node_key >node_modules/.installed
}
