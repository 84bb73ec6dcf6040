// Frames on the line: 0x00, COBS(payload, CRC-16/CCITT-FALSE), 0x00. The same as framing.py of the host.
#pragma once

#include "protocol.h"

namespace tapreach {

inline uint16_t crc16(const uint8_t* bytes, uint8_t count) {
  uint16_t crc = 0xFFFF;
  for (uint8_t i = 0; i < count; i++) {
    crc ^= uint16_t(bytes[i]) << 8;
    for (uint8_t bit = 0; bit < 8; bit++) crc = uint16_t(crc << 1) ^ (crc & 0x8000 ? 0x1021 : 0);
  }
  return crc;
}

// Decodes in place; returns the length, 0 for bytes that no encoder makes.
inline uint8_t cobs_decode(uint8_t* bytes, uint8_t count) {
  uint8_t from = 0, to = 0;
  while (from < count) {
    const uint8_t code = bytes[from];
    if (code == 0 || code > count - from) return 0;
    for (uint8_t i = 1; i < code; i++) bytes[to++] = bytes[from + i];
    from += code;
    if (from < count) bytes[to++] = 0;
  }
  return to;
}

// Encodes into `coded`, which holds one byte more; returns the length.
inline uint8_t cobs_encode(const uint8_t* bytes, uint8_t count, uint8_t* coded) {
  uint8_t code_at = 0, to = 1;
  for (uint8_t i = 0; i < count; i++) {
    if (bytes[i] == 0) {
      coded[code_at] = uint8_t(to - code_at);
      code_at = to++;
    } else {
      coded[to++] = bytes[i];
    }
  }
  coded[code_at] = uint8_t(to - code_at);
  return to;
}

// Gathers bytes up to a zero. What is too long is dropped with everything up to the next zero.
class FrameInput {
 public:
  uint16_t bad_frames = 0;

  // Returns the length of the payload that this byte completes, at `payload()`; 0 for none.
  uint8_t take(uint8_t byte) {
    if (byte != 0) {
      if (count_ < sizeof bytes_) bytes_[count_++] = byte;
      else is_too_long_ = true;
      return 0;
    }
    const uint8_t length = finish();
    if (length == 0 && count_ > 0) bad_frames++;
    count_ = 0;
    is_too_long_ = false;
    return length;
  }
  const uint8_t* payload() const { return bytes_; }

 private:
  uint8_t finish() {
    if (count_ == 0 || is_too_long_) return 0;
    const uint8_t length = cobs_decode(bytes_, count_);
    if (length < 4) return 0;
    const uint16_t told = uint16_t(bytes_[length - 2] | uint16_t(bytes_[length - 1]) << 8);
    return crc16(bytes_, uint8_t(length - 2)) == told ? uint8_t(length - 2) : 0;
  }

  uint8_t bytes_[protocol::LONGEST_FRAME];
  uint8_t count_ = 0;
  bool is_too_long_ = false;
};

// Builds a frame around a message and hands it to `send`.
template <typename Body>
void send_frame(void (*send)(const uint8_t*, uint8_t), uint8_t seq, const Body& body) {
  uint8_t payload[2 + Body::SIZE + 2], frame[sizeof payload + 3];
  payload[0] = Body::TYPE;
  payload[1] = seq;
  body.write(payload + 2);
  const uint16_t crc = crc16(payload, 2 + Body::SIZE);
  payload[2 + Body::SIZE] = uint8_t(crc);
  payload[3 + Body::SIZE] = uint8_t(crc >> 8);
  frame[0] = 0;
  const uint8_t length = cobs_encode(payload, sizeof payload, frame + 1);
  frame[1 + length] = 0;
  send(frame, uint8_t(length + 2));
}

}  // namespace tapreach
