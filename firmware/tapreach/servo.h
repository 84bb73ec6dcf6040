// One servo: soft limits, and a speed at which its pulse goes to the target.
#pragma once

#include "protocol.h"

namespace tapreach {

// Places are kept in 1/100 µs: a period of 10 ms at 1 µs/s is one of them.
class Servo {
 public:
  bool limit(uint16_t low_us, uint16_t high_us, uint16_t rest_us) {
    const bool is_range = protocol::PULSE_LOW_US <= low_us && low_us <= rest_us && rest_us <= high_us;
    if (!is_range || high_us > protocol::PULSE_HIGH_US) return false;
    low_us_ = low_us;
    high_us_ = high_us;
    rest_us_ = rest_us;
    if (is_on_) target_us_ = target_us_ < low_us ? low_us : target_us_ > high_us ? high_us : target_us_;
    return true;
  }

  bool allows(uint16_t us) const { return low_us_ <= us && us <= high_us_; }

  // `us` must be allowed. The first target is gone to from the rest pose, since nobody knows the true one.
  void go(uint16_t us, uint16_t speed_us_per_s) {
    if (!is_on_) place_ = rest_us_ * 100L;
    is_on_ = true;
    target_us_ = us;
    if (speed_us_per_s != 0) speed_ = speed_us_per_s;
  }

  void hold() { target_us_ = pulse_us(); }
  uint16_t pulse_us() const { return is_on_ ? uint16_t((place_ + 50) / 100) : 0; }
  uint16_t target_us() const { return is_on_ ? target_us_ : rest_us_; }

  void step() {
    const int32_t way = int32_t(target_us_) * 100 - place_;
    place_ += way > speed_ ? speed_ : way < -int32_t(speed_) ? -int32_t(speed_) : way;
  }

 private:
  static_assert(protocol::CONTROL_HZ == 100, "a step is 1/100 of the speed");

  uint16_t low_us_ = 1000, high_us_ = 2000, rest_us_ = 1500, target_us_ = 0, speed_ = 600;
  int32_t place_ = 0;
  bool is_on_ = false;
};

}  // namespace tapreach
