// What the board and the host say to each other. Integers are little-endian; the grammar is written
// down in ../arduino/README.md.
#ifndef EYEBOX_CAPTURE_PHOTODIODE_SERIAL_MESSAGES_H_
#define EYEBOX_CAPTURE_PHOTODIODE_SERIAL_MESSAGES_H_

#include <cstdint>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "capture/photodiode/serial/framing.h"

namespace eyebox::capture::serial {

inline constexpr uint8_t kProtocolVersion = 1;
inline constexpr size_t kMaxSamplesPerFrame = 16;

enum class RequestType : uint8_t { kHello = 0x10, kConfigure = 0x11, kStart = 0x12, kStop = 0x13 };

// Each is answered by one State with the same token.
struct Request {
  RequestType type = RequestType::kHello;
  uint8_t token = 0;
  uint32_t period_us = 0;  // kConfigure only; 0: a conversion for each pulse
};

struct State {
  uint8_t token = 0;
  uint8_t protocol = kProtocolVersion;
  uint8_t bits = 0;  // of the counts
  bool running = false;
  uint32_t period_us = 0;
  uint32_t minimum_period_us = 0;
  uint32_t micros = 0;  // the board's clock when it read the request
};

struct Samples {
  uint32_t sequence = 0;  // of the first conversion, counted from 0 at kStart; wraps
  struct Sample {
    uint32_t micros = 0;  // the board's clock when the conversion began; wraps after 71.6 minutes
    uint16_t counts = 0;
  };
  std::vector<Sample> samples;  // 1 to kMaxSamplesPerFrame, consecutive
};

using Message = std::variant<State, Samples>;

Bytes EncodeRequest(const Request& request);
std::optional<Request> DecodeRequest(std::span<const uint8_t> payload);

Bytes EncodeState(const State& state);
// Times ascend by at most 65535 us from one sample to the next.
Bytes EncodeSamples(const Samples& samples);

// Empty for an unknown type or a length that does not fit it.
std::optional<Message> DecodeMessage(std::span<const uint8_t> payload);

}  // namespace eyebox::capture::serial

#endif  // EYEBOX_CAPTURE_PHOTODIODE_SERIAL_MESSAGES_H_
