// The commands of ros_arduino_bridge, under the same limits as our own. One reply for each line.
#pragma once

#include "line_input.h"
#include "robot.h"

namespace tapreach {

class BridgeLines {
 public:
  explicit BridgeLines(Robot& robot) : robot_(robot) {}

  void take(const char* line, uint32_t now_us) {
    length_ = 0;
    if (!obey(line, now_us)) {
      length_ = 0;
      say("Invalid Command");
    }
    say("\r\n");
    robot_.hardware.send(reinterpret_cast<const uint8_t*>(reply_), length_);
  }

 private:
  static constexpr int16_t FRAMES_PER_S = 30;  // its speeds are ticks per PID frame
  static constexpr int16_t PULSE_0_US = 544, PULSE_RANGE_US = 1856;  // of the Servo library, for 180 degrees

  bool obey(const char* line, uint32_t now_us) {
    const char* rest = line[0] == 0 ? line : line + 1;
    switch (line[0]) {
      case 'e': return *rest == 0 && tell_ticks();
      case 'r': return *rest == 0 && reset();
      case 'b': return *rest == 0 && tell(long(protocol::BAUD));
      case 'm': return drive(rest, now_us);
      case 'o': return drive_raw(rest, now_us);
      case 'u': return set_gains(rest);
      case 's': return move_servo(rest);
      case 't': return tell_servo(rest);
      case 'a': return tell_analog(rest);
      case 'd': return tell_digital(rest);
      default: return false;
    }
  }

  bool drive(const char* rest, uint32_t now_us) {
    Numbers numbers(rest);
    const int32_t most = robot_.wheels.control.max_speed / FRAMES_PER_S;
    const int32_t left = numbers.next(' ', -most, most), right = numbers.next(' ', -most, most);
    if (!numbers.are_all()) return false;
    // Its users know `m 0 0` to stop at once, without a ramp.
    if (left == 0 && right == 0 && is_driving()) robot_.wheels.off(state::NEEDS_ZERO);
    const int16_t left_speed = int16_t(left * FRAMES_PER_S), right_speed = int16_t(right * FRAMES_PER_S);
    return accepted(robot_.wheels.drive(left_speed, right_speed, now_us, 0, protocol::LINE_DEADMAN_MS));
  }

  bool drive_raw(const char* rest, uint32_t now_us) {
    Numbers numbers(rest);
    const int32_t left = numbers.next(' ', -255, 255), right = numbers.next(' ', -255, 255);
    if (!numbers.are_all()) return false;
    const uint8_t answer =
        robot_.wheels.drive_raw(int16_t(left), int16_t(right), now_us, protocol::LINE_DEADMAN_MS);
    return accepted(answer);
  }

  // Its control adds up PWM every frame: its P over Ko is PWM per tick, its D over Ko PWM per tick and frame.
  bool set_gains(const char* rest) {
    if (*rest != ' ') return false;
    Numbers numbers(rest);
    const int32_t p = numbers.next(' ', 0, 255), d = numbers.next(':', 0, 255);
    numbers.next(':', 0, 255);  // its I adds up what our place already holds
    const int32_t over = numbers.next(':', 1, 255);
    if (!numbers.are_all() || is_driving()) return false;
    if (HAS_STEPPERS) return say("OK");  // these need none
    robot_.wheels.control.ki = float(p) / float(over);
    robot_.wheels.control.kp = float(d) / float(over * FRAMES_PER_S);
    return say("OK");
  }

  // The wheels are off afterwards. Latched faults are cleared too: there is no other line for it.
  bool reset() {
    robot_.stop();
    robot_.clear(0xFFFF);
    for (uint8_t i = 0; i < SIDES; i++) zero_[i] = robot_.wheels.both()[i].ticks();
    return say("OK");
  }

  bool move_servo(const char* rest) {
    Numbers numbers(rest);
    const int32_t index = numbers.next(' ', 0, protocol::SERVO_COUNT - 1);
    const int32_t degrees = numbers.next(' ', 0, 180);
    if (!numbers.are_all()) return false;
    protocol::Servos asked = {{0, 0, 0, 0}, {0, 0, 0, 0}};
    asked.pulse_us[index] = uint16_t(PULSE_0_US + degrees * PULSE_RANGE_US / 180);
    return accepted(robot_.move_servos(asked));
  }

  bool tell_servo(const char* rest) {
    Numbers numbers(rest);
    const int32_t index = numbers.next(' ', 0, protocol::SERVO_COUNT - 1);
    if (!numbers.are_all()) return false;
    const int32_t over = robot_.servos[index].target_us() - PULSE_0_US;
    return tell((over * 180 + PULSE_RANGE_US / 2) / PULSE_RANGE_US);
  }

  bool tell_analog(const char* rest) {
    Numbers numbers(rest);
    const int32_t value = robot_.hardware.analog(uint8_t(numbers.next(' ', 0, 15)));
    return numbers.are_all() && value >= 0 && tell(value);
  }

  bool tell_digital(const char* rest) {
    Numbers numbers(rest);
    const int32_t value = robot_.hardware.digital(uint8_t(numbers.next(' ', 0, 99)));
    return numbers.are_all() && value >= 0 && tell(value);
  }

  bool tell_ticks() {
    tell(int32_t(uint32_t(robot_.wheels.both()[LEFT].ticks()) - uint32_t(zero_[LEFT])));
    say(" ");
    return tell(int32_t(uint32_t(robot_.wheels.both()[RIGHT].ticks()) - uint32_t(zero_[RIGHT])));
  }

  bool is_driving() const { return robot_.wheels.state() == state::DRIVING; }
  bool accepted(uint8_t answer) { return answer == result::OK && say("OK"); }

  bool say(const char* text) {
    while (*text != 0 && length_ < sizeof reply_) reply_[length_++] = *text++;
    return true;
  }

  bool tell(int32_t value) {
    char digits[12];
    uint8_t at = sizeof digits - 1;
    uint32_t rest = value < 0 ? 0 - uint32_t(value) : uint32_t(value);
    digits[at] = 0;
    do digits[--at] = char('0' + rest % 10);
    while ((rest /= 10) != 0);
    if (value < 0) digits[--at] = '-';
    return say(digits + at);
  }

  Robot& robot_;
  int32_t zero_[SIDES] = {0, 0};
  char reply_[32];
  uint8_t length_ = 0;
};

}  // namespace tapreach
