// Steps at a rate, out of a timer that ticks at a fixed one: each step is counted, none is lost or doubled.
#pragma once

#include <stdint.h>

namespace tapreach {

class StepTrain {
 public:
  static constexpr int16_t TICK_HZ = 10000;
  static constexpr int16_t LARGEST_RATE = TICK_HZ / 2;  // a step is high for one tick and low for one

  // [steps/s]; 0 stops at once. Takes effect with the next tick.
  void set_rate(int16_t rate) {
    rate_ = rate > LARGEST_RATE ? LARGEST_RATE : rate < -LARGEST_RATE ? int16_t(-LARGEST_RATE) : rate;
    if (rate == 0) sum_ = 0;
  }

  // Every tick of the timer. Returns whether a step begins; drivers want to know its direction a tick before.
  bool tick() {
    if (rate_ == 0) return false;
    const bool forward = rate_ > 0;
    if (forward != forward_) {
      forward_ = forward;
      sum_ = 0;
      return false;
    }
    sum_ = int16_t(sum_ + (forward ? rate_ : -rate_));
    if (sum_ < TICK_HZ) return false;
    sum_ = int16_t(sum_ - TICK_HZ);
    return true;
  }

  bool is_forward() const { return forward_; }
  bool is_still() const { return rate_ == 0; }

 private:
  int16_t rate_ = 0, sum_ = 0;
  bool forward_ = true;
};

}  // namespace tapreach
