// Both wheels: what they are doing, who may make them move, and what takes them off.
#pragma once

#include "deadman.h"
#include "hardware.h"
#include "move.h"
#include "wheel.h"
#include "wiring.h"

namespace tapreach {

namespace result = protocol::result;
namespace state = protocol::state;

constexpr int32_t LONGEST_MOVE = 1000000;  // [ticks]: exact in a float

class Wheels {
 public:
  Control control;

  explicit Wheels(const Hardware& hardware) : wiring_(hardware) {}

  uint8_t state() const { return state_; }
  const Wheel* both() const { return wheels_; }
  const Move& move() const { return move_; }

  // Off at once. A move that was going on has ended: `take_moved` tells.
  void off(uint8_t next_state) {
    if (move_.id != 0) end_move(result_of(next_state));
    state_ = next_state;
    deadman_.forget();
    is_raw_ = false;
    for (uint8_t i = 0; i < SIDES; i++) {
      target_[i] = 0;
      asked_[i] = 0;
      wheels_[i].rest_at(wheels_[i].ticks());
    }
    wiring_.set_motors(0, 0);
  }

  // A speed that holds for `holds_ms`; the command is `age_us` old. [ticks/s]
  uint8_t drive(int16_t left, int16_t right, uint32_t now_us, int32_t age_us, uint16_t holds_ms) {
    const bool is_zero = left == 0 && right == 0;
    if (!is_speed(left) || !is_speed(right)) return result::OUT_OF_RANGE;
    const uint8_t refusal = refuses(is_zero);
    if (refusal != result::OK) return refusal;
    if (move_.id != 0 && !is_zero) return result::BUSY;
    if (move_.id != 0) end_move(protocol::move_result::STOPPED);
    if (is_raw_ || state_ == state::NEEDS_ZERO || state_ == state::TRIPPED) off(state::READY);
    asked_[LEFT] = left;
    asked_[RIGHT] = right;
    if (!is_zero) state_ = state::DRIVING;
    deadman_.feed(now_us, age_us, holds_ms);
    return result::OK;
  }

  // PWM as it is, past the speed control; for lines of ros_arduino_bridge alone.
  uint8_t drive_raw(int16_t left, int16_t right, uint32_t now_us, uint16_t holds_ms) {
    if (left == 0 && right == 0) return drive(0, 0, now_us, 0, holds_ms);
    if (HAS_STEPPERS) return result::UNKNOWN;  // steps without a ramp get lost
    const uint8_t refusal = refuses(false);
    if (refusal != result::OK) return refusal;
    if (move_.id != 0) return result::BUSY;
    is_raw_ = true;
    wheels_[LEFT].pwm = left;
    wheels_[RIGHT].pwm = right;
    state_ = state::DRIVING;
    deadman_.feed(now_us, 0, holds_ms);
    return result::OK;
  }

  uint8_t begin_move(const protocol::Move& asked, uint32_t now_us, int32_t age_us) {
    if (!is_move(asked)) return result::OUT_OF_RANGE;
    const uint8_t refusal = refuses(false);
    if (refusal != result::OK) return refusal;
    if (state_ != state::READY) return result::BUSY;
    for (uint8_t i = 0; i < SIDES; i++) wheels_[i].rest_at(wheels_[i].ticks());
    move_.begin(asked, wheels_);
    state_ = state::MOVING;
    deadman_.feed(now_us, age_us, protocol::DEADMAN_MS);
    return result::OK;
  }

  // Lengthens what was commanded before; brings nothing back that has ended.
  uint8_t keep(uint32_t now_us, int32_t age_us) {
    const uint8_t refusal = refuses(false);
    if (refusal == result::OK) deadman_.feed(now_us, age_us, protocol::DEADMAN_MS);
    return refusal;
  }

  uint8_t set_gains(const protocol::Gains& asked) {
    const bool is_speed = asked.max_speed >= 1 && asked.max_speed <= uint16_t(LARGEST_SPEED);
    if (!is_speed || asked.max_acceleration == 0) return result::OUT_OF_RANGE;
    if (state_ == state::DRIVING || state_ == state::MOVING) return result::BUSY;
    if (!HAS_STEPPERS) {  // these need none
      control.kp = asked.kp / 256.0f;
      control.ki = asked.ki / 256.0f;
      control.kd = asked.kd / 256.0f;
      control.feedforward = asked.feedforward / 256.0f;
    }
    control.max_speed = int16_t(asked.max_speed);
    control.max_acceleration = asked.max_acceleration;
    return result::OK;
  }

  uint8_t set_wiring(uint8_t reversed) {
    if (state_ == state::DRIVING || state_ == state::MOVING) return result::BUSY;
    wiring_.set(reversed);
    return result::OK;
  }

  // As often as possible.
  void watch(uint32_t now_us) {
    if (!deadman_.has_expired(now_us)) return;
    deadman_.forget();
    if (state_ == state::DRIVING || state_ == state::MOVING) off(state::TRIPPED);
  }

  // Once a period, before `step`.
  void measure() {
    int32_t ticks[SIDES];
    wiring_.read_ticks(ticks);
    for (uint8_t i = 0; i < SIDES; i++) wheels_[i].measure(ticks[i]);
  }

  void step() {
    if (state_ == state::MOVING) step_move();
    else if (state_ == state::DRIVING && !is_raw_) step_drive();
    const bool is_on = state_ == state::MOVING || state_ == state::DRIVING;
    if (is_on) wiring_.set_motors(wheels_[LEFT].pwm, wheels_[RIGHT].pwm);
  }

  // True once after a move has ended.
  bool take_moved(protocol::Moved& moved) {
    const bool has_ended = has_moved_;
    has_moved_ = false;
    moved = moved_;
    return has_ended;
  }

 private:
  static uint8_t result_of(uint8_t next_state) {
    if (next_state == state::TRIPPED) return protocol::move_result::TRIPPED;
    return next_state == state::FAULTED ? protocol::move_result::FAULTED : protocol::move_result::STOPPED;
  }

  uint8_t refuses(bool is_zero) const {
    if (state_ == state::FAULTED) return result::FAULTED;
    const bool is_off = state_ == state::NEEDS_ZERO || state_ == state::TRIPPED;
    return is_off && !is_zero ? result::NEEDS_ZERO : result::OK;
  }

  bool is_speed(int16_t speed) const { return speed >= -control.max_speed && speed <= control.max_speed; }

  bool is_move(const protocol::Move& asked) const {
    const bool is_near = asked.left >= -LONGEST_MOVE && asked.left <= LONGEST_MOVE &&
                         asked.right >= -LONGEST_MOVE && asked.right <= LONGEST_MOVE;
    return is_near && asked.id != 0 && asked.speed >= 1 && asked.speed <= uint16_t(control.max_speed) &&
           asked.acceleration >= 1 && asked.acceleration <= control.max_acceleration;
  }

  void end_move(uint8_t how) {
    moved_ = {move_.id, how, move_.gone(LEFT, wheels_[LEFT]), move_.gone(RIGHT, wheels_[RIGHT])};
    has_moved_ = true;
    move_.id = 0;
    state_ = state::DRIVING;  // so that it comes to rest by ramps from the speed that it has
    for (uint8_t i = 0; i < SIDES; i++) {
      target_[i] = wheels_[i].speed();
      wheels_[i].rest_at(wheels_[i].ticks());
    }
  }

  void step_move() {
    uint8_t how;
    if (!move_.step(wheels_, control, how)) return;
    end_move(how);
    off(state::READY);
  }

  void step_drive() {
    const float most = control.max_acceleration * PERIOD_S;
    for (uint8_t i = 0; i < SIDES; i++) target_[i] += clamp(float(asked_[i]) - target_[i], most);
    if (target_[LEFT] == 0 && target_[RIGHT] == 0 && asked_[LEFT] == 0 && asked_[RIGHT] == 0) {
      off(state::READY);
      return;
    }
    for (uint8_t i = 0; i < SIDES; i++) wheels_[i].follow_speed(target_[i], control);
  }

  Wiring wiring_;
  Wheel wheels_[SIDES];
  Move move_;
  Deadman deadman_;
  protocol::Moved moved_ = {0, 0, 0, 0};
  int16_t asked_[SIDES] = {0, 0};  // [ticks/s]
  float target_[SIDES] = {0, 0};   // on the way there, within the acceleration
  uint8_t state_ = state::NEEDS_ZERO;
  bool is_raw_ = false, has_moved_ = false;
};

}  // namespace tapreach
