// What the firmware asks of its board. Everything behind it is pure C++ and runs on a host as well.
#pragma once

#include <stdint.h>

namespace tapreach {

struct Hardware {
  uint32_t (*micros)();                            // [µs], wraps
  void (*set_motors)(int16_t left, int16_t right); // PWM −255..255, steppers: steps/s; 0 is off
  void (*read_ticks)(int32_t ticks[2]);            // both at one moment; wrap
  uint16_t (*illegal_steps)();                     // encoder steps that cannot be, since boot; wraps
  void (*set_pulse)(uint8_t servo, uint16_t us);   // 0: no pulses
  uint16_t (*battery_mv)();                        // 0 where nothing is connected
  bool (*stop_is_pulled)();
  void (*send)(const uint8_t* bytes, uint8_t count);
  void (*set_led)(bool is_on);
  int16_t (*analog)(uint8_t channel);              // −1: no such input
  int8_t (*digital)(uint8_t pin);                  // −1: no such pin
};

struct Identity {
  uint8_t board;
  uint16_t features;
  uint8_t reset_cause;
  uint16_t boot_id;
};

constexpr uint16_t FIRMWARE_VERSION = 1;
constexpr uint8_t LEFT = 0, RIGHT = 1, SIDES = 2;

// Age of a moment on a clock that wraps; right for ±35 minutes.
inline int32_t since(uint32_t now_us, uint32_t then_us) { return int32_t(now_us - then_us); }

}  // namespace tapreach
