// Latched faults and what sets them, looked at once a period.
#pragma once

#include "hardware.h"
#include "protocol.h"
#include "wheel.h"

#ifndef BATTERY_LOW_MV
#define BATTERY_LOW_MV 6000
#endif

namespace tapreach {

class Faults {
 public:
  uint16_t latched = 0;

  explicit Faults(const Hardware& hardware) : hardware_(hardware) {}

  void begin(uint8_t reset_cause) {
    if (reset_cause & protocol::reset_cause::WATCHDOG) latched |= protocol::fault::WATCHDOG_RESET;
    const bool is_first = reset_cause & protocol::reset_cause::POWER_ON;  // power that comes is low at first
    const bool was_low = reset_cause & protocol::reset_cause::BROWN_OUT;
    if (was_low && !is_first) latched |= protocol::fault::BROWN_OUT_RESET;
    illegal_ = hardware_.illegal_steps();
  }

  uint16_t battery_mv() const { return battery_mv_; }

  void step(const Wheel wheels[2]) {
    look_at_stop_input();
    look_at_battery();
    look_at_encoders(wheels);
  }

  // Returns false where a cause is still there.
  bool clear(uint16_t faults) {
    uint16_t present = 0;
    if (hardware_.stop_is_pulled()) present |= protocol::fault::STOP_INPUT;
    if (is_battery_low()) present |= protocol::fault::BATTERY_LOW;
    latched &= uint16_t(~faults | present);
    return (latched & faults) == 0;
  }

 private:
  static constexpr uint8_t STOP_PERIODS = 2;         // contacts bounce, wires pick up sparks
  static constexpr uint8_t BATTERY_EVERY = 10;       // periods
  static constexpr uint8_t BATTERY_LOOKS = 20;       // 2 s: a starting motor pulls it down for a moment
  static constexpr uint16_t NO_BATTERY_MV = 1000;    // supplied by USB: nothing to judge
  static constexpr int16_t HIGH_PWM = 150;
  static constexpr uint8_t STUCK_PERIODS = 50;
  static constexpr uint8_t ILLEGAL_EVERY = 100;      // periods
  static constexpr uint16_t ILLEGAL_STEPS = 20;      // in them

  void look_at_stop_input() {
    stop_periods_ = hardware_.stop_is_pulled() ? uint8_t(stop_periods_ + 1) : 0;
    if (stop_periods_ >= STOP_PERIODS) {
      latched |= protocol::fault::STOP_INPUT;
      stop_periods_ = STOP_PERIODS;
    }
  }

  bool is_battery_low() const { return battery_mv_ >= NO_BATTERY_MV && battery_mv_ < BATTERY_LOW_MV; }

  void look_at_battery() {
    if (battery_wait_++ % BATTERY_EVERY != 0) return;
    battery_wait_ = 1;
    battery_mv_ = hardware_.battery_mv();
    if (battery_mv_ < NO_BATTERY_MV) battery_mv_ = 0;
    low_looks_ = is_battery_low() ? uint8_t(low_looks_ + 1) : 0;
    if (low_looks_ < BATTERY_LOOKS) return;
    low_looks_ = BATTERY_LOOKS;
    latched |= protocol::fault::BATTERY_LOW;
  }

  void look_at_encoders(const Wheel wheels[2]) {
    for (uint8_t i = 0; i < SIDES; i++) {
      const bool is_pushed = wheels[i].pwm >= HIGH_PWM || wheels[i].pwm <= -HIGH_PWM;
      stuck_[i] = is_pushed && wheels[i].speed() == 0 ? uint8_t(stuck_[i] + 1) : 0;
      if (stuck_[i] < STUCK_PERIODS) continue;
      stuck_[i] = 0;
      latched |= protocol::fault::ENCODER_STUCK;
    }
    if (++illegal_wait_ < ILLEGAL_EVERY) return;
    illegal_wait_ = 0;
    const uint16_t now = hardware_.illegal_steps();
    if (uint16_t(now - illegal_) > ILLEGAL_STEPS) latched |= protocol::fault::ENCODER_ILLEGAL;
    illegal_ = now;
  }

  const Hardware& hardware_;
  uint16_t battery_mv_ = 0, illegal_ = 0;
  uint8_t stop_periods_ = 0, battery_wait_ = 0, low_looks_ = 0, stuck_[2] = {0, 0}, illegal_wait_ = 0;
};

}  // namespace tapreach
