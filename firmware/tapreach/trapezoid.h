// Distance over time with a constant acceleration, a constant speed and the same braking.
#pragma once

#include <math.h>

namespace tapreach {

class Trapezoid {
 public:
  // distance > 0, speed > 0, acceleration > 0; a short distance makes it a triangle.
  void begin(float distance, float speed, float acceleration) {
    distance_ = distance;
    acceleration_ = acceleration;
    const float top = sqrtf(distance * acceleration);
    speed_ = speed < top ? speed : top;
    ramp_s_ = speed_ / acceleration;
    duration_s_ = distance / speed_ + ramp_s_;
  }

  float duration_s() const { return duration_s_; }

  float distance_at(float t) const {
    if (t >= duration_s_) return distance_;
    if (t < ramp_s_) return 0.5f * acceleration_ * t * t;
    const float left_s = duration_s_ - t;
    if (left_s < ramp_s_) return distance_ - 0.5f * acceleration_ * left_s * left_s;
    return speed_ * (t - 0.5f * ramp_s_);
  }

  float speed_at(float t) const {
    if (t >= duration_s_) return 0;
    const float ramp_s = fminf(t, duration_s_ - t);
    return ramp_s < ramp_s_ ? acceleration_ * ramp_s : speed_;
  }

 private:
  float distance_ = 0, speed_ = 0, acceleration_ = 1, ramp_s_ = 0, duration_s_ = 0;
};

}  // namespace tapreach
