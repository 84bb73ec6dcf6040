// Which way round motors and encoders are wired: above it forward is positive, whatever a wire says.
#pragma once

#include "hardware.h"
#include "protocol.h"

namespace tapreach {

class Wiring {
 public:
  explicit Wiring(const Hardware& hardware) : hardware_(hardware) {}

  // Ticks go on from where they were.
  void set(uint8_t reversed) {
    int32_t before[SIDES], after[SIDES];
    read_ticks(before);
    reversed_ = reversed;
    read_ticks(after);
    for (uint8_t i = 0; i < SIDES; i++)
      offset_[i] += uint32_t(before[i]) - uint32_t(after[i]);
  }

  void set_motors(int16_t left, int16_t right) const {
    hardware_.set_motors(is_set(protocol::reversed::LEFT_MOTOR) ? int16_t(-left) : left,
                         is_set(protocol::reversed::RIGHT_MOTOR) ? int16_t(-right) : right);
  }

  void read_ticks(int32_t ticks[SIDES]) const {
    hardware_.read_ticks(ticks);
    for (uint8_t i = 0; i < SIDES; i++) {
      const uint32_t count = uint32_t(ticks[i]);
      ticks[i] = int32_t(offset_[i] + (is_set(uint8_t(protocol::reversed::LEFT_ENCODER << i)) ? 0 - count : count));
    }
  }

 private:
  bool is_set(uint8_t which) const { return reversed_ & which; }

  const Hardware& hardware_;
  uint32_t offset_[SIDES] = {0, 0};
  uint8_t reversed_ = 0;
};

}  // namespace tapreach
