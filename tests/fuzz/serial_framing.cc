// Bytes of the serial line, in pieces whose length the first byte gives. How they are cut changes
// nothing.
#include <algorithm>
#include <span>

#include "capture/photodiode/serial/framing.h"
#include "capture/photodiode/serial/messages.h"
#include "tests/fuzz/fuzz_input.h"

namespace eyebox::capture::serial {
namespace {

std::vector<Bytes> Split(std::span<const uint8_t> bytes, size_t piece, uint64_t& damaged) {
  FrameSplitter splitter;
  std::vector<Bytes> payloads;
  for (size_t at = 0; at < bytes.size(); at += piece) {
    splitter.Feed(bytes.subspan(at, std::min(piece, bytes.size() - at)), payloads);
  }
  damaged = splitter.damaged();
  return payloads;
}

void TryPayload(const Bytes& payload) {
  FUZZ_CHECK(!payload.empty() && payload.size() <= kMaxPayloadBytes);
  const Bytes framed = EncodeFrame(payload);
  FUZZ_CHECK(framed.back() == 0);
  FUZZ_CHECK(DecodeFrame(std::span(framed).first(framed.size() - 1)) == payload);
  if (const auto request = DecodeRequest(payload)) FUZZ_CHECK(EncodeRequest(*request) == payload);
  const auto message = DecodeMessage(payload);
  if (!message) return;
  const Samples* samples = std::get_if<Samples>(&*message);
  if (samples == nullptr) return;
  FUZZ_CHECK(!samples->samples.empty() && samples->samples.size() <= kMaxSamplesPerFrame);
  // The first time may be split over two fields of the payload: compare what is meant.
  const auto again = DecodeMessage(EncodeSamples(*samples));
  FUZZ_CHECK(again && EncodeSamples(std::get<Samples>(*again)) == EncodeSamples(*samples));
}

}  // namespace
}  // namespace eyebox::capture::serial

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace eyebox::capture::serial;
  if (size == 0) return 0;
  const std::span bytes(data + 1, size - 1);
  uint64_t damaged_whole = 0;
  uint64_t damaged_pieces = 0;
  const auto payloads = Split(bytes, std::max<size_t>(bytes.size(), 1), damaged_whole);
  FUZZ_CHECK(payloads == Split(bytes, 1 + data[0] % 16, damaged_pieces));
  FUZZ_CHECK(damaged_whole == damaged_pieces);
  for (const Bytes& payload : payloads) TryPayload(payload);
  // Also without a frame around it, which a checksum seldom lets through.
  if (!bytes.empty() && bytes.size() <= kMaxPayloadBytes) {
    TryPayload(Bytes(bytes.begin(), bytes.end()));
  }
  return 0;
}
