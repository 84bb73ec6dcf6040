// Why we started, a number for each start, and the watchdog that takes the wheels off when the program hangs.
#pragma once

#include <avr/eeprom.h>
#include <avr/wdt.h>

#include "pins.h"

namespace reset {

constexpr uint16_t HUNG = 0x5AFE;

// Left alone by the start-up code: RAM outlives all resets but power-on.
static uint8_t flags __attribute__((section(".noinit")));
static volatile uint16_t hung __attribute__((section(".noinit")));

// Before main and before the watchdog, which stays on through its own reset, strikes again.
__attribute__((naked, used, section(".init3"))) static void note_flags() {
  flags = MCUSR;
  MCUSR = 0;
  wdt_disable();
}

// Boot loaders may have cleared the flags already; a mark in RAM tells a hang apart all the same.
static uint8_t cause() {
  uint8_t found = 0;
  if (flags & _BV(PORF)) found |= protocol::reset_cause::POWER_ON;
  if (flags & _BV(EXTRF)) found |= protocol::reset_cause::EXTERNAL;
  if (flags & _BV(BORF)) found |= protocol::reset_cause::BROWN_OUT;
  const bool was_powered = !(flags & _BV(PORF));
  if (flags & _BV(WDRF) || (was_powered && hung == HUNG)) found |= protocol::reset_cause::WATCHDOG;
  hung = 0;
  return found;
}

static uint16_t next_boot_id() {
  const uint16_t id = uint16_t(eeprom_read_word(nullptr) + 1);
  eeprom_write_word(nullptr, id);
  return id;
}

// After 120 ms without `alive` the wheels go off, after 120 ms more the microcontroller starts anew.
static inline void begin_watchdog() {
  wdt_enable(WDTO_120MS);
  WDTCSR |= _BV(WDIE);
}

static inline void alive() {
  wdt_reset();
  WDTCSR |= _BV(WDIE);
}

}  // namespace reset
