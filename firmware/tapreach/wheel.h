// One wheel: its speed measured, and the PWM that makes it follow a moving reference.
#pragma once

#include <math.h>
#include <stdint.h>

#include "control.h"
#include "protocol.h"

namespace tapreach {

constexpr float PERIOD_S = 1.0f / protocol::CONTROL_HZ;
constexpr uint32_t PERIOD_US = 1000000UL / protocol::CONTROL_HZ;

inline float clamp(float value, float limit) {
  return value > limit ? limit : value < -limit ? -limit : value;
}

// The reference is a place [ticks] that moves: the integral of the speed error is the error of the place.
class Wheel {
 public:
  int16_t pwm = 0;  // with TAPREACH_STEPPER: steps/s

  // Forgets the past: stands at `ticks`.
  void rest_at(int32_t ticks) {
    reference_ = ticks;
    fraction_ = push_ = last_error_ = 0;
    pwm = 0;
  }

  // Once a period: notes the ticks, of which five periods make the speed.
  void measure(int32_t ticks) {
    ticks_ = ticks;
    speed_ = float(int32_t(uint32_t(ticks) - uint32_t(past_[at_]))) * (1.0f / (WINDOW * PERIOD_S));
    past_[at_] = ticks;
    at_ = uint8_t((at_ + 1) % WINDOW);
  }

  float speed() const { return speed_; }
  int32_t ticks() const { return ticks_; }

  // Moves the reference on by a period of this speed, and follows. A wheel that is held does not wind it up.
  void follow_speed(float speed, const Control& control) {
    fraction_ += speed * PERIOD_S;
    const int32_t whole = int32_t(fraction_);
    fraction_ -= float(whole);
    reference_ = int32_t(uint32_t(reference_) + uint32_t(whole));
    const int32_t farthest = control.ki > 0 ? int32_t(fminf(LARGEST_OUTPUT / control.ki, 10000)) + 1 : 10000;
    const int32_t error = error_to(reference_);
    if (error > farthest) reference_ = int32_t(uint32_t(ticks_) + uint32_t(farthest));
    if (error < -farthest) reference_ = int32_t(uint32_t(ticks_) - uint32_t(farthest));
    follow(reference_, speed, control);
  }

  // Follows a reference that somebody else moves.
  void follow(int32_t reference, float speed, const Control& control) {
    reference_ = reference;
    const float error = clamp(speed, 32767) - speed_;
    // The reference is where it is to be after this period; steps come exactly, so nothing is to make up for that.
    const float due = HAS_STEPPERS ? speed * PERIOD_S : 0;
    const float place = control.ki * (float(error_to(reference)) - due);
    const float change = (error - last_error_) * (1 / PERIOD_S);
    last_error_ = error;
    const float by_speed = control.feedforward * speed + control.kp * error + control.kd * change;
    pwm = int16_t(clamp(by_speed + clamp(place, LARGEST_OUTPUT) + push_, LARGEST_OUTPUT));
  }

  // Towards a place where it is to stand: pushes harder while it sticks, lets go where it is near enough.
  void settle(int32_t place, const Control& control) {
    const int32_t error = error_to(place);
    if (error >= -NEAR_TICKS && error <= NEAR_TICKS) {
      push_ = 0;
      pwm = 0;
      return;
    }
    push_ = speed_ == 0 ? clamp(push_ + (error > 0 ? PUSH : -PUSH), LARGEST_OUTPUT) : push_ * 0.8f;
    follow(place, 0, control);
  }

  int32_t error_to(int32_t place) const { return int32_t(uint32_t(place) - uint32_t(ticks_)); }

 private:
  static constexpr uint8_t WINDOW = 5;
  static constexpr float PUSH = 2.5f;  // PWM a period: all of it within a second

  int32_t reference_ = 0, ticks_ = 0, past_[WINDOW] = {0, 0, 0, 0, 0};
  float fraction_ = 0, speed_ = 0, push_ = 0, last_error_ = 0;
  uint8_t at_ = 0;
};

}  // namespace tapreach
