// Two stepper motors behind drivers with STEP, DIR and ENABLE (low: on), as A4988 and DRV8825. They stand in for
// motors and encoders alike: the steps that were made are the ticks.
#pragma once

#include <util/atomic.h>

#include "pins.h"
#include "step_train.h"

namespace steppers {

using tapreach::StepTrain;
constexpr uint16_t RELEASE_TICKS = 5 * StepTrain::TICK_HZ;  // still for so long: no current, no heat

static StepTrain trains[2];
static volatile int32_t ticks[2];
static volatile uint8_t *step_port[2], *direction_port[2];
static uint8_t step_mask[2], direction_mask[2];
static uint16_t still_ticks;

static inline void tick_one(uint8_t side) {
  *step_port[side] &= uint8_t(~step_mask[side]);
  const bool steps = trains[side].tick();
  if (trains[side].is_forward()) *direction_port[side] |= direction_mask[side];
  else *direction_port[side] &= uint8_t(~direction_mask[side]);
  if (!steps) return;
  *step_port[side] |= step_mask[side];
  if (trains[side].is_forward()) ticks[side]++;
  else ticks[side]--;
}

static inline void tick() {
  tick_one(0);
  tick_one(1);
  if (!trains[0].is_still() || !trains[1].is_still()) still_ticks = 0;
  else if (still_ticks < RELEASE_TICKS && ++still_ticks == RELEASE_TICKS) digitalWrite(pins::STANDBY, HIGH);
}

// Compare A is the top, B interrupts: the vector of A belongs to tone() of the Arduino core.
static inline void begin_timer() {
#if defined(__AVR_ATmega32U4__)
  TCCR3A = 0;
  TCCR3B = _BV(WGM32) | _BV(CS31);
  OCR3A = F_CPU / 8 / StepTrain::TICK_HZ - 1;
  TIMSK3 = _BV(OCIE3B);
#else
  TCCR2A = _BV(WGM21);
  TCCR2B = _BV(CS21);
  OCR2A = F_CPU / 8 / StepTrain::TICK_HZ - 1;
  TIMSK2 = _BV(OCIE2B);
#endif
}

}  // namespace steppers

#if defined(__AVR_ATmega32U4__)
ISR(TIMER3_COMPB_vect) { steppers::tick(); }
#else
ISR(TIMER2_COMPB_vect) { steppers::tick(); }
#endif

namespace motors {

static void begin() {
  digitalWrite(pins::STANDBY, HIGH);
  pinMode(pins::STANDBY, OUTPUT);
  for (uint8_t side = 0; side < 2; side++) {
    const uint8_t step = pins::PWM[side], direction = pins::FORWARD[side];
    pinMode(step, OUTPUT);
    pinMode(direction, OUTPUT);
    steppers::step_port[side] = portOutputRegister(digitalPinToPort(step));
    steppers::step_mask[side] = digitalPinToBitMask(step);
    steppers::direction_port[side] = portOutputRegister(digitalPinToPort(direction));
    steppers::direction_mask[side] = digitalPinToBitMask(direction);
  }
  ATOMIC_BLOCK(ATOMIC_RESTORESTATE) { steppers::begin_timer(); }
}

// [steps/s]. Off, they hold for five seconds and let go then.
static void set(int16_t left, int16_t right) {
  ATOMIC_BLOCK(ATOMIC_RESTORESTATE) {
    steppers::trains[0].set_rate(left);
    steppers::trains[1].set_rate(right);
    if (left != 0 || right != 0) {
      steppers::still_ticks = 0;
      digitalWrite(pins::STANDBY, LOW);
    }
  }
}

}  // namespace motors

namespace encoders {

static void begin() {}

static void read(int32_t counts[2]) {
  ATOMIC_BLOCK(ATOMIC_RESTORESTATE) {
    counts[0] = steppers::ticks[0];
    counts[1] = steppers::ticks[1];
  }
}

static uint16_t illegal_steps() { return 0; }

}  // namespace encoders
