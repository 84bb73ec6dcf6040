// Between events the processor sleeps. A byte, an encoder or the pulse of a servo wakes it at once, Timer0, by which
// the core counts time, every 1.024 ms; over USB, whose bytes have no interrupt, it is found then.
#pragma once

#include <avr/interrupt.h>
#include <avr/sleep.h>
#include <stdint.h>

namespace idle {

constexpr uint16_t LONGEST_US = 1100;  // the 1.024 ms, and the way there and back

// `has_work` is asked with interrupts off: what comes after it wakes us, as `sei` lets one more instruction pass.
template <typename Question>
static inline void sleep_unless(Question has_work) {
  set_sleep_mode(SLEEP_MODE_IDLE);
  cli();
  if (!has_work()) {
    sleep_enable();
    sei();
    sleep_cpu();
    sleep_disable();
  }
  sei();
}

}  // namespace idle
