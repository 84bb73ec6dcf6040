// The firmware for steppers above its registers, on the host: two step trains at the ticks of their timer.
#include <stdlib.h>
#include <string.h>

#include <new>

#include "core.h"
#include "step_train.h"

namespace {

using tapreach::StepTrain;
constexpr uint32_t TICK_US = 1000000 / StepTrain::TICK_HZ;

struct World {
  uint64_t now_us, off_since_us, turns_without_notice;
  StepTrain trains[2];
  int32_t ticks[2];
  int16_t rates[2], largest_jump;
  bool was_forward[2];
  uint16_t pulses[4];
  uint8_t out[65536];
  uint32_t out_count;
} world;

uint32_t now_us() { return uint32_t(world.now_us); }
void set_motors(int16_t left, int16_t right) {
  const int16_t asked[2] = {left, right};
  const bool is_off = left == 0 && right == 0;
  if (is_off && (world.rates[0] || world.rates[1])) world.off_since_us = world.now_us;
  for (int i = 0; i < 2; i++) {
    const int16_t jump = int16_t(abs(asked[i] - world.rates[i]));
    if (!is_off && jump > world.largest_jump) world.largest_jump = jump;  // off is at once, whatever the speed
    world.rates[i] = asked[i];
    world.trains[i].set_rate(asked[i]);
  }
}
void read_ticks(int32_t ticks[2]) { memcpy(ticks, world.ticks, sizeof world.ticks); }
uint16_t illegal_steps() { return 0; }
void set_pulse(uint8_t servo, uint16_t us) { world.pulses[servo] = us; }
uint16_t battery_mv() { return 7400; }
bool stop_is_pulled() { return false; }
void send(const uint8_t* bytes, uint8_t count) {
  if (world.out_count + count > sizeof world.out) return;
  memcpy(world.out + world.out_count, bytes, count);
  world.out_count += count;
}
void set_led(bool) {}
int16_t analog(uint8_t) { return 0; }
int8_t digital(uint8_t) { return 0; }

const tapreach::Hardware HARDWARE = {now_us,     set_motors,     read_ticks, illegal_steps, set_pulse, battery_mv,
                                     stop_is_pulled, send,       set_led,    analog,        digital};
tapreach::Identity identity;
alignas(tapreach::Core) unsigned char storage[sizeof(tapreach::Core)];
tapreach::Core* core = nullptr;

void tick_one(int i) {
  const bool steps = world.trains[i].tick(), forward = world.trains[i].is_forward();
  // A driver must have seen its direction before the edge of the step.
  if (steps && forward != world.was_forward[i]) world.turns_without_notice++;
  world.was_forward[i] = forward;
  if (steps) world.ticks[i] += forward ? 1 : -1;
}

}  // namespace

extern "C" {

void boot(uint64_t at_us, uint8_t reset_cause) {
  world = World();
  world.now_us = at_us;
  identity = {protocol::board::HOST, protocol::feature::STEPPER, reset_cause, 7};
  core = new (storage) tapreach::Core(HARDWARE, identity);
  core->begin();
}

void run(uint64_t us) {
  for (const uint64_t end = world.now_us + us; world.now_us < end;) {
    world.now_us += TICK_US;
    for (int i = 0; i < 2; i++) tick_one(i);
    core->poll();
  }
}

void receive(const uint8_t* bytes, uint32_t count) {
  for (uint32_t i = 0; i < count; i++) core->receive(bytes[i]);
}

uint32_t take_output(uint8_t* bytes) {
  const uint32_t count = world.out_count;
  memcpy(bytes, world.out, count);
  world.out_count = 0;
  return count;
}

uint64_t now() { return world.now_us; }
uint64_t off_since() { return world.off_since_us; }
uint64_t turns_without_notice() { return world.turns_without_notice; }
int pwm(int side) { return world.rates[side]; }
double angle(int side) { return world.ticks[side]; }
int pulse(int servo) { return world.pulses[servo]; }
int take_largest_jump() {
  const int jump = world.largest_jump;
  world.largest_jump = 0;
  return jump;
}
}
