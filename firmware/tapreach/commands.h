// Framed commands: each is answered, and moves something only within a session that Hello opened.
#pragma once

#include "framing.h"
#include "robot.h"

namespace tapreach {

class Commands {
 public:
  uint16_t refused_frames = 0;

  Commands(Robot& robot, const Identity& identity) : robot_(robot), identity_(identity) {}

  bool is_open() const { return is_open_; }

  // A payload whose CRC is right: type, seq, body.
  void take(const uint8_t* payload, uint8_t length, uint32_t now_us) {
    const uint8_t seq = payload[1];
    const uint8_t* body = payload + 2;
    length = uint8_t(length - 2);
    if (payload[0] == protocol::Hello::TYPE && length == protocol::Hello::SIZE)
      return hello(body, seq, now_us);
    if (payload[0] == protocol::Ping::TYPE && length == protocol::Ping::SIZE) return ping(body, seq, now_us);
    const uint8_t answer = is_open_ ? obey(payload[0], body, length, now_us) : result::NO_SESSION;
    if (is_open_) heard_us_ = now_us;
    if (answer == result::UNKNOWN || answer == result::BAD_LENGTH) refused_frames++;
    const protocol::Ack ack = {seq, answer};
    send_frame(robot_.hardware.send, seq_++, ack);
  }

  // Closes a session whose host has fallen silent.
  void watch(uint32_t now_us) {
    if (!is_open_ || since(now_us, heard_us_) < int32_t(protocol::SESSION_SILENCE_MS) * 1000) return;
    is_open_ = false;
    take_off();
  }

  void send_moved() {
    protocol::Moved moved;
    if (robot_.wheels.take_moved(moved) && is_open_) send_frame(robot_.hardware.send, seq_++, moved);
  }

  void send_telemetry(uint32_t now_us) {
    const Wheels& wheels = robot_.wheels;
    const Wheel *left = &wheels.both()[LEFT], *right = &wheels.both()[RIGHT];
    protocol::Telemetry told;
    told.at_us = now_us;
    told.left = left->ticks();
    told.right = right->ticks();
    told.left_speed = int16_t(clamp(left->speed(), 32767));
    told.right_speed = int16_t(clamp(right->speed(), 32767));
    for (uint8_t i = 0; i < protocol::SERVO_COUNT; i++) told.pulse_us[i] = robot_.servos[i].pulse_us();
    told.battery_mv = robot_.faults.battery_mv();
    told.faults = robot_.faults.latched;
    told.state = wheels.state();
    told.move_id = wheels.move().id;
    told.move_left = wheels.move().left(wheels.both());
    send_frame(robot_.hardware.send, seq_++, told);
  }

 private:
  // A new host begins with wheels that are off, whatever the one before had said.
  void hello(const uint8_t* body, uint8_t seq, uint32_t now_us) {
    protocol::Hello told;
    told.read(body);
    take_off();
    is_open_ = told.version == protocol::VERSION;
    heard_us_ = now_us;
    const protocol::Welcome welcome = {protocol::VERSION,      identity_.board,        FIRMWARE_VERSION,
                                       identity_.features,     protocol::DEADMAN_MS,   protocol::TELEMETRY_HZ,
                                       identity_.reset_cause,  identity_.boot_id};
    send_frame(robot_.hardware.send, seq, welcome);
  }

  void ping(const uint8_t* body, uint8_t seq, uint32_t now_us) {
    protocol::Ping told;
    told.read(body);
    if (is_open_) heard_us_ = now_us;
    const protocol::Pong pong = {told.token, robot_.hardware.micros()};
    send_frame(robot_.hardware.send, seq, pong);
  }

  void take_off() {
    if (robot_.wheels.state() != state::FAULTED) robot_.wheels.off(state::NEEDS_ZERO);
  }

  template <typename Body>
  static bool fits(const uint8_t* from, uint8_t length, Body& body) {
    if (length != Body::SIZE) return false;
    body.read(from);
    return true;
  }

  uint8_t obey(uint8_t type, const uint8_t* body, uint8_t length, uint32_t now_us) {
    switch (type) {
      case protocol::Drive::TYPE: return drive(body, length, now_us);
      case protocol::Move::TYPE: return move(body, length, now_us);
      case protocol::Keep::TYPE: return keep(body, length, now_us);
      case protocol::Stop::TYPE: return stop(length);
      case protocol::Servos::TYPE: return servos(body, length);
      case protocol::Clear::TYPE: return clear(body, length);
      case protocol::Gains::TYPE: return gains(body, length);
      case protocol::ServoLimits::TYPE: return servo_limits(body, length);
      case protocol::Wiring::TYPE: return wiring(body, length);
      case protocol::Hello::TYPE:
      case protocol::Ping::TYPE: return result::BAD_LENGTH;
      default: return result::UNKNOWN;
    }
  }

  uint8_t drive(const uint8_t* from, uint8_t length, uint32_t now_us) {
    protocol::Drive asked;
    if (!fits(from, length, asked)) return result::BAD_LENGTH;
    const int32_t age_us = Deadman::age_us(asked.at_ms, now_us);
    if (!Deadman::is_timely(age_us)) return result::TOO_OLD;
    return robot_.wheels.drive(asked.left, asked.right, now_us, age_us, protocol::DEADMAN_MS);
  }

  uint8_t move(const uint8_t* from, uint8_t length, uint32_t now_us) {
    protocol::Move asked;
    if (!fits(from, length, asked)) return result::BAD_LENGTH;
    const int32_t age_us = Deadman::age_us(asked.at_ms, now_us);
    if (!Deadman::is_timely(age_us)) return result::TOO_OLD;
    return robot_.wheels.begin_move(asked, now_us, age_us);
  }

  uint8_t keep(const uint8_t* from, uint8_t length, uint32_t now_us) {
    protocol::Keep asked;
    if (!fits(from, length, asked)) return result::BAD_LENGTH;
    const int32_t age_us = Deadman::age_us(asked.at_ms, now_us);
    return Deadman::is_timely(age_us) ? robot_.wheels.keep(now_us, age_us) : result::TOO_OLD;
  }

  uint8_t stop(uint8_t length) {
    if (length != protocol::Stop::SIZE) return result::BAD_LENGTH;
    robot_.stop();
    return result::OK;
  }

  uint8_t servos(const uint8_t* from, uint8_t length) {
    protocol::Servos asked;
    return fits(from, length, asked) ? robot_.move_servos(asked) : result::BAD_LENGTH;
  }

  uint8_t clear(const uint8_t* from, uint8_t length) {
    protocol::Clear asked;
    return fits(from, length, asked) ? robot_.clear(asked.faults) : result::BAD_LENGTH;
  }

  uint8_t gains(const uint8_t* from, uint8_t length) {
    protocol::Gains asked;
    return fits(from, length, asked) ? robot_.wheels.set_gains(asked) : result::BAD_LENGTH;
  }

  uint8_t servo_limits(const uint8_t* from, uint8_t length) {
    protocol::ServoLimits asked;
    return fits(from, length, asked) ? robot_.limit_servo(asked) : result::BAD_LENGTH;
  }

  uint8_t wiring(const uint8_t* from, uint8_t length) {
    protocol::Wiring asked;
    if (!fits(from, length, asked)) return result::BAD_LENGTH;
    const uint8_t motors = asked.reversed & 3, encoders = uint8_t(asked.reversed >> 2);
    // Without quadrature the direction of a count is that of the motor: turned round is both or neither.
    const bool is_alike = (identity_.features & protocol::feature::QUADRATURE) || motors == encoders;
    return encoders <= 3 && is_alike ? robot_.wheels.set_wiring(asked.reversed) : uint8_t(result::OUT_OF_RANGE);
  }

  Robot& robot_;
  const Identity& identity_;
  uint32_t heard_us_ = 0;
  uint8_t seq_ = 0;
  bool is_open_ = false;
};

}  // namespace tapreach
