// ASCII lines ended by CR, and the numbers in them. One byte that is not printable drops the line.
#pragma once

#include <stdint.h>

namespace tapreach {

class LineInput {
 public:
  // Returns true when this byte ends a line; it is then at `text()`, ended by a zero.
  bool take(uint8_t byte) {
    if (byte == '\r' || byte == 0) {
      const bool is_line = byte == '\r' && !is_dropped_;
      text_[count_] = 0;
      reset();
      return is_line;
    }
    if (byte < 0x20 || byte > 0x7E || count_ >= sizeof text_ - 1) is_dropped_ = true;
    else text_[count_++] = char(byte);
    return false;
  }

  void reset() {
    count_ = 0;
    is_dropped_ = false;
  }

  const char* text() const { return text_; }

 private:
  char text_[32];
  uint8_t count_ = 0;
  bool is_dropped_ = false;
};

// Reads numbers, each after exactly one separator; anything else makes it fail and stay so.
class Numbers {
 public:
  explicit Numbers(const char* text) : at_(text) {}

  int32_t next(char separator, int32_t low, int32_t high) {
    if (*at_ != separator) is_good_ = false;
    else at_++;
    const bool is_negative = *at_ == '-';
    if (is_negative) at_++;
    int32_t value = 0;
    uint8_t digits = 0;
    for (; *at_ >= '0' && *at_ <= '9' && digits < 7; digits++) value = value * 10 + (*at_++ - '0');
    value = is_negative ? -value : value;
    if (digits == 0 || value < low || value > high) is_good_ = false;
    return value;
  }

  bool are_all() const { return is_good_ && *at_ == 0; }

 private:
  const char* at_;
  bool is_good_ = true;
};

}  // namespace tapreach
