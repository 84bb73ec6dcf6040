// Values of a message body: little-endian, in order, without padding.
#pragma once

#include <stdint.h>

namespace protocol {

struct BodyReader {
  const uint8_t* at;
  void take(uint8_t& value) { value = *at++; }
  void take(uint16_t& value) {
    value = uint16_t(at[0] | uint16_t(at[1]) << 8);
    at += 2;
  }
  void take(int16_t& value) { take(reinterpret_cast<uint16_t&>(value)); }
  void take(uint32_t& value) {
    uint16_t low, high;
    take(low);
    take(high);
    value = low | uint32_t(high) << 16;
  }
  void take(int32_t& value) { take(reinterpret_cast<uint32_t&>(value)); }
};

struct BodyWriter {
  uint8_t* at;
  void put(uint8_t value) { *at++ = value; }
  void put(uint16_t value) { put(uint8_t(value)); put(uint8_t(value >> 8)); }
  void put(int16_t value) { put(uint16_t(value)); }
  void put(uint32_t value) { put(uint16_t(value)); put(uint16_t(value >> 16)); }
  void put(int32_t value) { put(uint32_t(value)); }
};

}  // namespace protocol
