// What makes a wheel follow: gains and limits. With TAPREACH_STEPPER the output is steps a second instead of PWM.
#pragma once

#include <stdint.h>

#include "protocol.h"

namespace tapreach {

#if defined(TAPREACH_STEPPER)

// Steps are made exactly: the speed goes straight through, and the place is held by a little more or less of it.
constexpr bool HAS_STEPPERS = true;
constexpr float LARGEST_OUTPUT = 5000;  // [steps/s]: half the ticks of the timer
constexpr int16_t LARGEST_SPEED = 4500;
constexpr int32_t NEAR_TICKS = 0, SETTLED_TICKS = 0;
struct Control {
  float kp = 0, ki = 8, kd = 0, feedforward = 1;
  int16_t max_speed = LARGEST_SPEED;
  uint16_t max_acceleration = 6000;
};

#else

constexpr bool HAS_STEPPERS = false;
constexpr float LARGEST_OUTPUT = 255;  // PWM
constexpr int16_t LARGEST_SPEED = 32767;
constexpr int32_t NEAR_TICKS = 1, SETTLED_TICKS = protocol::SETTLED_TICKS;  // let go there; at rest there
struct Control {
  float kp = 20 / 256.0f, ki = 200 / 256.0f, kd = 0, feedforward = 20 / 256.0f;
  int16_t max_speed = 4000;
  uint16_t max_acceleration = 8000;
};

#endif

}  // namespace tapreach
