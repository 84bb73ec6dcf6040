// What there is to command, whoever speaks: wheels, servos, faults, and the host that has the session.
#pragma once

#include "faults.h"
#include "servo.h"
#include "wheels.h"

namespace tapreach {

struct Robot {
  const Hardware& hardware;
  Wheels wheels;
  Faults faults;
  Servo servos[protocol::SERVO_COUNT];

  explicit Robot(const Hardware& board) : hardware(board), wheels(board), faults(board) {}

  void begin(uint8_t reset_cause) {
    faults.begin(reset_cause);
    wheels.measure();
    wheels.off(protocol::state::NEEDS_ZERO);
  }

  // One period of control.
  void step() {
    wheels.measure();
    faults.step(wheels.both());
    obey_faults();
    if (is_stopped()) hold_servos();
    wheels.step();
    for (uint8_t i = 0; i < protocol::SERVO_COUNT; i++) {
      servos[i].step();
      hardware.set_pulse(i, servos[i].pulse_us());
    }
  }

  void obey_faults() {
    if (faults.latched != 0 && wheels.state() != state::FAULTED) wheels.off(state::FAULTED);
  }

  void stop() {
    if (wheels.state() != state::FAULTED) wheels.off(state::NEEDS_ZERO);
    hold_servos();
  }

  uint8_t clear(uint16_t which) {
    const bool is_clear = faults.clear(which);
    if (faults.latched == 0 && wheels.state() == state::FAULTED) wheels.off(state::NEEDS_ZERO);
    return is_clear ? result::OK : result::FAULTED;
  }

  // All of them or none.
  uint8_t move_servos(const protocol::Servos& asked) {
    for (uint8_t i = 0; i < protocol::SERVO_COUNT; i++)
      if (asked.pulse_us[i] != 0 && !servos[i].allows(asked.pulse_us[i])) return result::OUT_OF_RANGE;
    if (is_stopped()) return result::FAULTED;
    for (uint8_t i = 0; i < protocol::SERVO_COUNT; i++)
      if (asked.pulse_us[i] != 0) servos[i].go(asked.pulse_us[i], asked.speed_us_per_s[i]);
    return result::OK;
  }

  uint8_t limit_servo(const protocol::ServoLimits& asked) {
    const bool is_good = asked.index < protocol::SERVO_COUNT &&
                         servos[asked.index].limit(asked.low_us, asked.high_us, asked.rest_us);
    return is_good ? result::OK : result::OUT_OF_RANGE;
  }

 private:
  bool is_stopped() const { return faults.latched & protocol::fault::STOP_INPUT; }

  void hold_servos() {
    for (uint8_t i = 0; i < protocol::SERVO_COUNT; i++) servos[i].hold();
  }
};

}  // namespace tapreach
