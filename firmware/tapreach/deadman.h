// Wheels turn only while somebody has lately meant it. Times are moments of sending, not of arrival.
#pragma once

#include "hardware.h"
#include "protocol.h"

namespace tapreach {

class Deadman {
 public:
  // Age [µs] of a command sent at at_ms. The host's count is our microseconds over 1000, so that times 1000
  // it is our count again, wraps included.
  static int32_t age_us(uint32_t at_ms, uint32_t now_us) { return since(now_us, uint32_t(at_ms * 1000UL)); }

  static bool is_timely(int32_t age_us) {
    return age_us <= int32_t(protocol::OLDEST_MS) * 1000 && age_us >= -int32_t(protocol::EARLIEST_MS) * 1000;
  }

  // A command of this age holds for `holds_ms` from when it was sent; one from ahead counts as sent now.
  void feed(uint32_t now_us, int32_t age_us, uint16_t holds_ms) {
    const uint32_t until_us = now_us - uint32_t(age_us > 0 ? age_us : 0) + uint32_t(holds_ms) * 1000;
    if (!is_fed_ || since(until_us, until_us_) > 0) until_us_ = until_us;
    is_fed_ = true;
  }

  bool has_expired(uint32_t now_us) const { return !is_fed_ || since(now_us, until_us_) >= 0; }
  void forget() { is_fed_ = false; }

 private:
  uint32_t until_us_ = 0;
  bool is_fed_ = false;
};

}  // namespace tapreach
