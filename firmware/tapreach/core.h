// The whole firmware above its registers: bytes in, bytes out, and a period of control every 10 ms.
#pragma once

#include "bridge_lines.h"
#include "commands.h"
#include "framing.h"
#include "line_input.h"
#include "robot.h"

namespace tapreach {

class Core {
 public:
  Core(const Hardware& hardware, const Identity& identity)
      : hardware_(hardware),
        identity_(identity),
        robot_(hardware),
        commands_(robot_, identity),
        bridge_(robot_) {}

  void begin() {
    robot_.begin(identity_.reset_cause);
    due_us_ = hardware_.micros();
  }

  void receive(uint8_t byte) {
    const uint8_t length = frames_.take(byte);
    if (length > 0) commands_.take(frames_.payload(), length, hardware_.micros());
    if (commands_.is_open()) lines_.reset();
    else if (lines_.take(byte)) bridge_.take(lines_.text(), hardware_.micros());
    commands_.send_moved();
  }

  // As often as possible. Returns true when a period of control was done.
  bool poll() {
    const uint32_t now_us = hardware_.micros();
    robot_.wheels.watch(now_us);
    commands_.watch(now_us);
    commands_.send_moved();
    if (since(now_us, due_us_) < 0) return false;
    note_delay(now_us);
    robot_.step();
    commands_.send_moved();
    period_++;
    show_state();
    if (commands_.is_open() && period_ % TELEMETRY_PERIODS == 0) commands_.send_telemetry(now_us);
    return true;
  }

  // Whether the next period of control begins within `us`.
  bool is_due_within(uint16_t us) const { return since(due_us_, hardware_.micros()) <= int32_t(us); }

  const Robot& robot() const { return robot_; }
  uint16_t bad_frames() const { return uint16_t(frames_.bad_frames + commands_.refused_frames); }
  bool is_open() const { return commands_.is_open(); }

 private:
  static constexpr int32_t OVERRUN_US = 2 * int32_t(PERIOD_US);
  static constexpr uint8_t TELEMETRY_PERIODS = protocol::CONTROL_HZ / protocol::TELEMETRY_HZ;

  // A period that comes a little late keeps the rhythm; after a long gap it begins anew and is a fault.
  void note_delay(uint32_t now_us) {
    if (since(now_us, due_us_) > OVERRUN_US) {
      robot_.faults.latched |= protocol::fault::LOOP_OVERRUN;
      due_us_ = now_us;
    }
    due_us_ += PERIOD_US;
  }

  // Quick blinking: a fault. Slow: a zero is needed. On: ready, or turning.
  void show_state() {
    const uint8_t now = robot_.wheels.state();
    const bool is_off = now == state::NEEDS_ZERO || now == state::TRIPPED;
    const uint8_t half = now == state::FAULTED ? 10 : 50;
    hardware_.set_led((now != state::FAULTED && !is_off) || period_ / half % 2 == 0);
  }

  const Hardware& hardware_;
  const Identity& identity_;
  Robot robot_;
  Commands commands_;
  BridgeLines bridge_;
  FrameInput frames_;
  LineInput lines_;
  uint32_t due_us_ = 0;
  uint16_t period_ = 0;
};

}  // namespace tapreach
