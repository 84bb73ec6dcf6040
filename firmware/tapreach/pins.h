// Which pin does what, on each board. PWM stands where simavr shows it; encoders share one port, whose change
// interrupt reads both wheels at once. Two direction pins for each motor: IN1, IN2 of L298N and TB6612 alike.
#pragma once

#include <Arduino.h>
#undef EXTERNAL  // of analogReference; a reset cause has the name

#include "protocol.h"

namespace pins {

#if defined(__AVR_ATmega2560__)
constexpr uint8_t BOARD = protocol::board::MEGA;
constexpr uint8_t PWM[2] = {4, 13}, FORWARD[2] = {24, 26}, REVERSE[2] = {25, 27};
constexpr uint8_t SERVO[4] = {9, 10, 11, 12}, STANDBY = 29, STOP = 28, LED = 22, BATTERY = A0;
constexpr uint8_t ENCODER_A[2] = {A8, A10}, ENCODER_B[2] = {A9, A11};
constexpr uint8_t A_BIT[2] = {0, 2}, B_BIT[2] = {1, 3};
#define ENCODER_PORT PINK
#define ENCODER_MASK PCMSK2
#define ENCODER_ENABLE PCIE2
#define ENCODER_VECTOR PCINT2_vect

#elif defined(ARDUINO_AVR_PROMICRO)  // an ATmega32U4 whose pins 11 to 13, A4 and A5 lead nowhere
constexpr uint8_t BOARD = protocol::board::LEONARDO;
constexpr uint8_t PWM[2] = {5, 3}, FORWARD[2] = {A1, A3}, REVERSE[2] = {A2, 14};
constexpr uint8_t SERVO[4] = {2, 4, 6, 7}, STANDBY = 1, STOP = 15, LED = 17, BATTERY = A0;
constexpr uint8_t ENCODER_A[2] = {8, 10}, ENCODER_B[2] = {9, 16};
constexpr uint8_t A_BIT[2] = {4, 6}, B_BIT[2] = {5, 2};
#define ENCODER_PORT PINB
#define ENCODER_MASK PCMSK0
#define ENCODER_ENABLE PCIE0
#define ENCODER_VECTOR PCINT0_vect

#elif defined(__AVR_ATmega32U4__)
#if defined(ARDUINO_AVR_YUN)
constexpr uint8_t BOARD = protocol::board::YUN;
#else
constexpr uint8_t BOARD = protocol::board::LEONARDO;
#endif
constexpr uint8_t PWM[2] = {5, 3}, FORWARD[2] = {A1, A3}, REVERSE[2] = {A2, A4};
constexpr uint8_t SERVO[4] = {2, 4, 6, 12}, STANDBY = 7, STOP = A5, LED = 13, BATTERY = A0;
constexpr uint8_t ENCODER_A[2] = {8, 10}, ENCODER_B[2] = {9, 11};
constexpr uint8_t A_BIT[2] = {4, 6}, B_BIT[2] = {5, 7};
#define ENCODER_PORT PINB
#define ENCODER_MASK PCMSK0
#define ENCODER_ENABLE PCIE0
#define ENCODER_VECTOR PCINT0_vect

#elif defined(__AVR_ATmega328P__)
constexpr uint8_t BOARD = protocol::board::UNO;
constexpr uint8_t PWM[2] = {5, 6}, FORWARD[2] = {A1, A3}, REVERSE[2] = {A2, A4};
constexpr uint8_t SERVO[4] = {9, 10, 11, 12}, STANDBY = A5, STOP = 8, LED = 13, BATTERY = A0;
constexpr uint8_t ENCODER_A[2] = {2, 3}, ENCODER_B[2] = {4, 7};
constexpr uint8_t A_BIT[2] = {2, 3}, B_BIT[2] = {4, 7};
#define ENCODER_PORT PIND
#define ENCODER_MASK PCMSK2
#define ENCODER_ENABLE PCIE2
#define ENCODER_VECTOR PCINT2_vect

#else
#error "no pins are known for this microcontroller: ATmega328P, ATmega2560 or ATmega32U4"
#endif

}  // namespace pins
