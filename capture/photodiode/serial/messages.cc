#include "capture/photodiode/serial/messages.h"

namespace eyebox::capture::serial {
namespace {

constexpr uint8_t kSamplesType = 0x01;
constexpr uint8_t kStateType = 0x02;
constexpr size_t kStateBytes = 17;
constexpr size_t kSamplesHeadBytes = 10;
constexpr size_t kSampleBytes = 4;

template <typename T>
void Put(Bytes& bytes, T value) {
  for (size_t i = 0; i < sizeof(T); ++i) {
    bytes.push_back(static_cast<uint8_t>(value >> (8 * i) & 0xff));
  }
}

// Takes integers off the front; the caller has checked the length.
class Taker {
 public:
  explicit Taker(std::span<const uint8_t> bytes) : bytes_(bytes) {}
  template <typename T>
  T Take() {
    T value = 0;
    for (size_t i = 0; i < sizeof(T); ++i) {
      value = static_cast<T>(value | static_cast<T>(bytes_[i]) << (8 * i));
    }
    bytes_ = bytes_.subspan(sizeof(T));
    return value;
  }

 private:
  std::span<const uint8_t> bytes_;
};

std::optional<Message> DecodeState(std::span<const uint8_t> payload) {
  if (payload.size() != kStateBytes) return std::nullopt;
  Taker taker(payload.subspan(1));
  State state;
  state.token = taker.Take<uint8_t>();
  state.protocol = taker.Take<uint8_t>();
  state.bits = taker.Take<uint8_t>();
  state.running = taker.Take<uint8_t>() != 0;
  state.period_us = taker.Take<uint32_t>();
  state.minimum_period_us = taker.Take<uint32_t>();
  state.micros = taker.Take<uint32_t>();
  return state;
}

std::optional<Message> DecodeSamples(std::span<const uint8_t> payload) {
  if (payload.size() < kSamplesHeadBytes) return std::nullopt;
  Taker taker(payload.subspan(1));
  const size_t count = taker.Take<uint8_t>();
  if (count == 0 || count > kMaxSamplesPerFrame) return std::nullopt;
  if (payload.size() != kSamplesHeadBytes + count * kSampleBytes) return std::nullopt;
  Samples samples;
  samples.sequence = taker.Take<uint32_t>();
  auto micros = taker.Take<uint32_t>();
  for (size_t i = 0; i < count; ++i) {
    micros += taker.Take<uint16_t>();
    samples.samples.push_back({.micros = micros, .counts = taker.Take<uint16_t>()});
  }
  return samples;
}

}  // namespace

Bytes EncodeRequest(const Request& request) {
  Bytes bytes = {static_cast<uint8_t>(request.type), request.token};
  if (request.type == RequestType::kConfigure) Put(bytes, request.period_us);
  return bytes;
}

std::optional<Request> DecodeRequest(std::span<const uint8_t> payload) {
  if (payload.size() < 2 || payload[0] < 0x10 || payload[0] > 0x13) return std::nullopt;
  Request request = {.type = static_cast<RequestType>(payload[0]), .token = payload[1]};
  const bool configures = request.type == RequestType::kConfigure;
  if (payload.size() != (configures ? 6 : 2)) return std::nullopt;
  if (configures) request.period_us = Taker(payload.subspan(2)).Take<uint32_t>();
  return request;
}

Bytes EncodeState(const State& state) {
  Bytes bytes = {kStateType, state.token, state.protocol, state.bits,
                 static_cast<uint8_t>(state.running ? 1 : 0)};
  Put(bytes, state.period_us);
  Put(bytes, state.minimum_period_us);
  Put(bytes, state.micros);
  return bytes;
}

Bytes EncodeSamples(const Samples& samples) {
  Bytes bytes = {kSamplesType, static_cast<uint8_t>(samples.samples.size())};
  Put(bytes, samples.sequence);
  uint32_t micros = samples.samples.front().micros;
  Put(bytes, micros);
  for (const Samples::Sample& sample : samples.samples) {
    Put(bytes, static_cast<uint16_t>(sample.micros - micros));
    Put(bytes, sample.counts);
    micros = sample.micros;
  }
  return bytes;
}

std::optional<Message> DecodeMessage(std::span<const uint8_t> payload) {
  if (payload.empty()) return std::nullopt;
  if (payload[0] == kStateType) return DecodeState(payload);
  if (payload[0] == kSamplesType) return DecodeSamples(payload);
  return std::nullopt;
}

}  // namespace eyebox::capture::serial
