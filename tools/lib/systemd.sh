# shellcheck shell=sh
# The tests verify the unit that `tapreach install` writes by systemd's own checker; nothing of it is started.

want_systemd_package() { has systemd-analyze || want_package systemd; }
