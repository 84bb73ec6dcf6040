// Encoders in one interrupt: the port is read once for both wheels. Full quadrature counts four ticks a cycle;
// with ENCODER_SINGLE only channel A counts, and the direction is that of the motor.
#pragma once

#include <util/atomic.h>

#include "pins.h"

namespace encoders {

static volatile int32_t ticks[2];
static volatile uint16_t illegal;
static volatile int8_t motor_sign[2] = {1, 1};
static uint8_t last[2];

// By last (A, B) and present (A, B): A leads going forward. 2: both changed, a step was missed.
static const int8_t STEP[16] = {0, -1, 1, 2, 1, 0, 2, -1, -1, 2, 0, 1, 2, 1, -1, 0};

static inline uint8_t channels(uint8_t port, uint8_t side) {
  const uint8_t a = port >> pins::A_BIT[side] & 1, b = port >> pins::B_BIT[side] & 1;
  return uint8_t(a << 1 | b);
}

static inline void note(uint8_t port, uint8_t side) {
  const uint8_t now = channels(port, side), before = last[side];
  if (now == before) return;
  last[side] = now;
#if defined(ENCODER_SINGLE)
  if ((now ^ before) & 2) ticks[side] += motor_sign[side];
#else
  const int8_t step = STEP[before << 2 | now];
  if (step == 2) illegal++;
  else ticks[side] += step;
#endif
}

static inline void begin() {
  for (uint8_t side = 0; side < 2; side++) {
    pinMode(pins::ENCODER_A[side], INPUT_PULLUP);
    pinMode(pins::ENCODER_B[side], INPUT_PULLUP);
    ENCODER_MASK |= uint8_t(1 << pins::A_BIT[side] | 1 << pins::B_BIT[side]);
  }
  for (uint8_t side = 0; side < 2; side++) last[side] = channels(ENCODER_PORT, side);
  PCICR |= 1 << ENCODER_ENABLE;
}

static void read(int32_t counts[2]) {
  ATOMIC_BLOCK(ATOMIC_RESTORESTATE) {
    counts[0] = ticks[0];
    counts[1] = ticks[1];
  }
}

static uint16_t illegal_steps() {
  uint16_t count;
  ATOMIC_BLOCK(ATOMIC_RESTORESTATE) { count = illegal; }
  return count;
}

}  // namespace encoders

ISR(ENCODER_VECTOR) {
  const uint8_t port = ENCODER_PORT;
  encoders::note(port, 0);
  encoders::note(port, 1);
}
