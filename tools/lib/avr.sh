# shellcheck shell=sh
# Tests build the firmware as a user would, with the compiler and the Arduino core of Debian, and run it in simavr.
# Without these packages they are skipped, but under CI.

arduino_core=/usr/share/arduino/hardware/arduino/avr

want_avr_packages() {
  { has avr-gcc && [ -d "$arduino_core" ]; } || want_package gcc-avr avr-libc arduino-core-avr
  has g++ || want_package g++
  [ -e /usr/include/simavr/sim_avr.h ] || want_package libsimavr-dev libelf-dev
}
