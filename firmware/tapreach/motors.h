// Two motors behind an H-bridge with PWM and two direction pins a side; STANDBY wakes a TB6612.
#pragma once

#include "encoders.h"
#include "pins.h"

namespace motors {

static void begin() {
  for (uint8_t side = 0; side < 2; side++) {
    digitalWrite(pins::PWM[side], LOW);
    pinMode(pins::PWM[side], OUTPUT);
    pinMode(pins::FORWARD[side], OUTPUT);
    pinMode(pins::REVERSE[side], OUTPUT);
  }
#if defined(MOTOR_TB6612)
  pinMode(pins::STANDBY, OUTPUT);
#endif
}

static inline void set_one(uint8_t side, int16_t pwm) {
  digitalWrite(pins::FORWARD[side], pwm > 0);
  digitalWrite(pins::REVERSE[side], pwm < 0);
  analogWrite(pins::PWM[side], pwm < 0 ? -pwm : pwm);
  if (pwm != 0) encoders::motor_sign[side] = pwm > 0 ? 1 : -1;
}

static void set(int16_t left, int16_t right) {
#if defined(MOTOR_TB6612)
  digitalWrite(pins::STANDBY, left != 0 || right != 0);
#endif
  set_one(0, left);
  set_one(1, right);
}

}  // namespace motors
