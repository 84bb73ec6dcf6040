// Servo pulses on Timer1: one servo after the other, then the rest of 20 ms. Half microseconds are counted.
#pragma once

#include <util/atomic.h>

#include "pins.h"

namespace pulses {

constexpr uint8_t COUNT = 4;
constexpr uint16_t FRAME_US = 20000, SKIPPED_US = 50;

static volatile uint16_t wanted_us[COUNT];
static volatile uint8_t* port[COUNT];
static uint8_t mask[COUNT];
static uint8_t slot = COUNT;

static inline void begin() {
  for (uint8_t i = 0; i < COUNT; i++) {
    pinMode(pins::SERVO[i], OUTPUT);
    port[i] = portOutputRegister(digitalPinToPort(pins::SERVO[i]));
    mask[i] = digitalPinToBitMask(pins::SERVO[i]);
  }
  ATOMIC_BLOCK(ATOMIC_RESTORESTATE) {
    TCCR1A = 0;
    TCCR1B = _BV(WGM12) | _BV(CS11);
    TCNT1 = 0;
    OCR1A = 2 * SKIPPED_US;
    TIMSK1 = _BV(OCIE1A);
  }
}

static void set(uint8_t servo, uint16_t us) {
  ATOMIC_BLOCK(ATOMIC_RESTORESTATE) { wanted_us[servo] = us; }
}

static inline void next() {
  static uint16_t used_us;
  if (slot < COUNT) *port[slot] &= uint8_t(~mask[slot]);
  slot = slot >= COUNT ? 0 : uint8_t(slot + 1);
  if (slot == 0) used_us = 0;
  if (slot == COUNT) {
    OCR1A = 2 * (FRAME_US - used_us) - 1;
    return;
  }
  const uint16_t us = wanted_us[slot];
  if (us != 0) *port[slot] |= mask[slot];
  OCR1A = 2 * (us != 0 ? us : SKIPPED_US) - 1;
  used_us += us != 0 ? us : SKIPPED_US;
}

}  // namespace pulses

ISR(TIMER1_COMPA_vect) { pulses::next(); }
