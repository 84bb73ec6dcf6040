// The firmware above its registers, on the host: time, pins and two motors are made here, steps of 100 µs.
#include <math.h>
#include <string.h>

#include <new>

#include "core.h"

namespace {

constexpr uint32_t STEP_US = 100;

struct Motor {
  double speed, angle;  // [ticks/s], [ticks]
};

struct World {
  uint64_t now_us;
  Motor motors[2];
  int16_t pwm[2];
  uint64_t off_since_us;
  uint16_t pulses[4], battery_mv, illegal;
  bool is_stopped, is_held, has_led;
  bool motor_is_reversed[2], encoder_is_reversed[2];
  uint8_t out[65536];
  uint32_t out_count;
  uint64_t pushes;  // periods in which a motor had PWM
} world;

// A geared motor: free speed 3500 ticks/s at full PWM, 80 ms, and it sticks below PWM 25.
void step_motor(Motor& motor, int pwm, double dt) {
  const double stick = 25, most = 3500;
  double drive = pwm;
  if (world.is_held) drive = motor.speed = 0;
  if (fabs(motor.speed) < 20) {
    drive = fabs(drive) < stick ? 0 : drive - copysign(15, drive);
    if (drive == 0) motor.speed = 0;
  } else {
    drive -= copysign(15, motor.speed);
  }
  motor.speed += (drive * most / 240 - motor.speed) * dt / 0.08;
  motor.angle += motor.speed * dt;
}

uint32_t now_us() { return uint32_t(world.now_us); }
void set_motors(int16_t left, int16_t right) {
  const bool was_on = world.pwm[0] || world.pwm[1];
  world.pwm[0] = left;
  world.pwm[1] = right;
  if (was_on && !left && !right) world.off_since_us = world.now_us;
  if (left || right) world.pushes++;
}
void read_ticks(int32_t ticks[2]) {
  for (int i = 0; i < 2; i++) {
    const double angle = world.encoder_is_reversed[i] ? -world.motors[i].angle : world.motors[i].angle;
    ticks[i] = int32_t(int64_t(floor(angle)));
  }
}
uint16_t illegal_steps() { return world.illegal; }
void set_pulse(uint8_t servo, uint16_t us) { world.pulses[servo] = us; }
uint16_t battery_mv() { return world.battery_mv; }
bool stop_is_pulled() { return world.is_stopped; }
void send(const uint8_t* bytes, uint8_t count) {
  if (world.out_count + count > sizeof world.out) return;
  memcpy(world.out + world.out_count, bytes, count);
  world.out_count += count;
}
void set_led(bool is_on) { world.has_led = is_on; }
int16_t analog(uint8_t channel) { return int16_t(100 + channel); }
int8_t digital(uint8_t pin) { return pin < 20 ? int8_t(pin & 1) : int8_t(-1); }

const tapreach::Hardware HARDWARE = {now_us,     set_motors,     read_ticks, illegal_steps, set_pulse, battery_mv,
                                     stop_is_pulled, send, set_led,    analog,        digital};
tapreach::Identity identity;
alignas(tapreach::Core) unsigned char storage[sizeof(tapreach::Core)];
tapreach::Core* core = nullptr;

}  // namespace

extern "C" {

void boot(uint64_t at_us, uint8_t reset_cause) {
  world = World();
  world.now_us = at_us;
  world.battery_mv = 7400;
  identity = {protocol::board::HOST, protocol::feature::QUADRATURE, reset_cause, 7};
  core = new (storage) tapreach::Core(HARDWARE, identity);
  core->begin();
}

void run(uint64_t us) {
  for (const uint64_t end = world.now_us + us; world.now_us < end;) {
    world.now_us += STEP_US;
    for (int i = 0; i < 2; i++) {
      const int pwm = world.motor_is_reversed[i] ? -world.pwm[i] : world.pwm[i];
      step_motor(world.motors[i], pwm, STEP_US / 1e6);
    }
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

void skip(uint64_t us) { world.now_us += us; }
uint64_t now() { return world.now_us; }
uint64_t off_since() { return world.off_since_us; }
uint64_t pushes() { return world.pushes; }
int pwm(int side) { return world.pwm[side]; }
double angle(int side) { return world.motors[side].angle; }
void set_angle(int side, double ticks) { world.motors[side].angle = ticks; }
int pulse(int servo) { return world.pulses[servo]; }
void set_battery(int mv) { world.battery_mv = uint16_t(mv); }
void set_stop(int is_pulled) { world.is_stopped = is_pulled; }
// Bits as of Reversed.
void wire_up(int reversed) {
  for (int i = 0; i < 2; i++) {
    world.motor_is_reversed[i] = reversed >> i & 1;
    world.encoder_is_reversed[i] = reversed >> (2 + i) & 1;
  }
}
void hold_wheels(int is_held) { world.is_held = is_held; }
void add_illegal(int count) { world.illegal = uint16_t(world.illegal + count); }
uint32_t bad_frames() { return core->bad_frames(); }
}
