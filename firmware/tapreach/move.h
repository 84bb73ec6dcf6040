// A relative move: one trapezoid for both wheels, so that they start and end together.
#pragma once

#include "trapezoid.h"
#include "wheel.h"

namespace tapreach {

class Move {
 public:
  uint8_t id = 0;  // 0: none

  void begin(const protocol::Move& asked, const Wheel wheels[2]) {
    id = asked.id;
    distance_[0] = asked.left;
    distance_[1] = asked.right;
    const float left = fabsf(float(asked.left)), right = fabsf(float(asked.right));
    longest_ = fmaxf(fmaxf(left, right), 1);
    profile_.begin(longest_, asked.speed, asked.acceleration);
    for (uint8_t i = 0; i < 2; i++) start_[i] = wheels[i].ticks();
    periods_ = 0;
  }

  // One period. Returns true when it has ended; `result` says how.
  bool step(Wheel wheels[2], const Control& control, uint8_t& result) {
    const float t = float(++periods_) * PERIOD_S;
    if (t < profile_.duration_s()) {
      const float share = profile_.distance_at(t) / longest_, speed = profile_.speed_at(t) / longest_;
      for (uint8_t i = 0; i < 2; i++)
        wheels[i].follow(place(i, share), speed * float(distance_[i]), control);
      return false;
    }
    for (uint8_t i = 0; i < 2; i++) wheels[i].settle(place(i, 1), control);
    result = protocol::move_result::DONE;
    if (stands(wheels[0], 0) && stands(wheels[1], 1)) return true;
    result = protocol::move_result::STALLED;
    return t > profile_.duration_s() + PATIENCE_S;
  }

  // Ticks that a wheel has gone since the beginning.
  int32_t gone(uint8_t i, const Wheel& wheel) const { return -wheel.error_to(start_[i]); }

  // How much of it is still to go, as the wheels stand [1/1000].
  uint16_t left(const Wheel wheels[2]) const {
    if (id == 0) return 0;
    const uint8_t i = fabsf(float(distance_[0])) >= fabsf(float(distance_[1])) ? 0 : 1;
    const float share = fabsf(float(wheels[i].error_to(place(i, 1)))) / longest_;
    return uint16_t(fminf(1000, 1000 * share + 0.5f));
  }

 private:
  static constexpr float PATIENCE_S = 2;

  int32_t place(uint8_t i, float share) const {
    const int32_t on = share >= 1 ? distance_[i] : int32_t(lroundf(float(distance_[i]) * share));
    return int32_t(uint32_t(start_[i]) + uint32_t(on));
  }
  bool stands(const Wheel& wheel, uint8_t i) const {
    const int32_t error = wheel.error_to(place(i, 1));
    return wheel.speed() == 0 && error <= SETTLED_TICKS && error >= -SETTLED_TICKS;
  }

  Trapezoid profile_;
  int32_t distance_[2] = {0, 0}, start_[2] = {0, 0};
  float longest_ = 1;
  uint32_t periods_ = 0;
};

}  // namespace tapreach
