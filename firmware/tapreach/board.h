// The registers of a real board behind `Hardware`.
#pragma once

#include "hardware.h"
#if defined(TAPREACH_STEPPER)
#include "steppers.h"
#else
#include "encoders.h"
#include "motors.h"
#endif
#include "pins.h"
#include "pulses.h"
#include "reset.h"

#ifndef HOST_BAUD
#define HOST_BAUD protocol::BAUD
#endif
#ifndef BATTERY_DIVIDER
#define BATTERY_DIVIDER 3  // battery voltage over that at the pin: 20 kOhm above 10 kOhm
#endif

// The Linux side of a Yun is on Serial1; HOST_ON_SERIAL1 says the same of any other 32U4.
#if defined(ARDUINO_AVR_YUN) || defined(HOST_ON_SERIAL1)
#define HOST_SERIAL Serial1
#else
#define HOST_SERIAL Serial
#endif
#if defined(__AVR_ATmega32U4__) && !defined(ARDUINO_AVR_YUN) && !defined(HOST_ON_SERIAL1)
#define HOST_IS_USB
#endif

namespace board {

// Levels are read from the registers: digitalRead would switch the PWM of a pin off.
static bool level(uint8_t pin) { return *portInputRegister(digitalPinToPort(pin)) & digitalPinToBitMask(pin); }

static bool stop_is_pulled() {
#if defined(STOP_NORMALLY_CLOSED)
  return level(pins::STOP);  // a cut wire stops as well
#else
  return !level(pins::STOP);
#endif
}

// Going to sleep begins a conversion of the channel that was read last: it is left to end first, or it would be taken
// for that of another.
static uint16_t read_analog(uint8_t channel) {
  loop_until_bit_is_clear(ADCSRA, ADSC);
  return uint16_t(analogRead(channel));
}

static uint16_t battery_mv() {
  return uint16_t(uint32_t(read_analog(pins::BATTERY)) * (5000UL * BATTERY_DIVIDER) / 1023);
}

static void send(const uint8_t* bytes, uint8_t count) {
#if defined(HOST_IS_USB)
  if (HOST_SERIAL.availableForWrite() < count) return;  // nobody listens: never wait for them
#endif
  HOST_SERIAL.write(bytes, count);
}

static void set_led(bool is_on) { digitalWrite(pins::LED, is_on); }
static uint32_t now_us() { return micros(); }
static int16_t analog(uint8_t channel) { return channel < NUM_ANALOG_INPUTS ? int16_t(read_analog(channel)) : -1; }
static int8_t digital(uint8_t pin) { return pin < NUM_DIGITAL_PINS ? int8_t(level(pin)) : -1; }

static uint16_t features() {
  uint16_t has = protocol::feature::SERVOS | protocol::feature::BATTERY | protocol::feature::STOP_INPUT;
#if defined(TAPREACH_STEPPER)
  has |= protocol::feature::STEPPER;
#elif !defined(ENCODER_SINGLE)
  has |= protocol::feature::QUADRATURE;
#endif
  return has;
}

static const tapreach::Hardware HARDWARE = {
    now_us,     motors::set,    encoders::read, encoders::illegal_steps, pulses::set, battery_mv,
    stop_is_pulled, send,       set_led,        analog,                  digital,
};

static void begin() {
  motors::begin();
  pinMode(pins::STOP, INPUT_PULLUP);
  pinMode(pins::LED, OUTPUT);
  encoders::begin();
  pulses::begin();
  HOST_SERIAL.begin(HOST_BAUD);
}

}  // namespace board

// The program hangs: wheels off by the registers alone, and a mark for the start that follows.
ISR(WDT_vect) {
  motors::set(0, 0);
  reset::hung = reset::HUNG;
  for (;;) {
  }
}
