// Firmware of a Tapreach robot: core.h is what it does, board.h how it reaches its pins.
#include "board.h"
#include "core.h"
#include "idle.h"

static tapreach::Identity identity;
static tapreach::Core core(board::HARDWARE, identity);

void setup() {
  board::begin();
  identity = {pins::BOARD, board::features(), reset::cause(), reset::next_boot_id()};
  reset::begin_watchdog();
  core.begin();
}

void loop() {
  // Few bytes at a time: whatever is sent to us, the deadman and the control come round in time.
  for (uint8_t i = 0; i < 8 && HOST_SERIAL.available() > 0; i++) core.receive(uint8_t(HOST_SERIAL.read()));
  if (core.poll()) reset::alive();
  // A period is waited for awake, so that it comes as even as ever.
  if (!core.is_due_within(idle::LONGEST_US)) idle::sleep_unless([] { return HOST_SERIAL.available() > 0; });
}
