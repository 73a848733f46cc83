#include "capture/photodiode/serial/framing.h"

namespace eyebox::capture::serial {
namespace {

// Payload, CRC and one byte of stuffing (payloads are shorter than a COBS group of 254).
constexpr size_t kMaxStuffedBytes = kMaxPayloadBytes + 2 + 1;
static_assert(kMaxStuffedBytes <= 255);

Bytes Stuff(std::span<const uint8_t> plain) {
  Bytes stuffed = {0};
  size_t code_at = 0;
  for (const uint8_t byte : plain) {
    if (byte == 0) {
      stuffed[code_at] = static_cast<uint8_t>(stuffed.size() - code_at);
      code_at = stuffed.size();
    }
    stuffed.push_back(byte);
  }
  stuffed[code_at] = static_cast<uint8_t>(stuffed.size() - code_at);
  return stuffed;
}

std::optional<Bytes> Unstuff(std::span<const uint8_t> stuffed) {
  Bytes plain;
  for (size_t at = 0; at < stuffed.size();) {
    const size_t code = stuffed[at];
    if (code == 0 || at + code > stuffed.size()) return std::nullopt;
    if (at > 0) plain.push_back(0);
    plain.insert(plain.end(), stuffed.begin() + at + 1, stuffed.begin() + at + code);
    at += code;
  }
  return plain;
}

}  // namespace

uint16_t Crc16(std::span<const uint8_t> bytes) {
  uint16_t crc = 0xffff;
  for (const uint8_t byte : bytes) {
    crc = static_cast<uint16_t>(crc ^ (byte << 8));
    for (int bit = 0; bit < 8; ++bit) {
      const bool carry = (crc & 0x8000) != 0;
      crc = static_cast<uint16_t>(crc << 1);
      if (carry) crc ^= 0x1021;
    }
  }
  return crc;
}

Bytes EncodeFrame(std::span<const uint8_t> payload) {
  Bytes plain(payload.begin(), payload.end());
  const uint16_t crc = Crc16(payload);
  plain.push_back(static_cast<uint8_t>(crc & 0xff));
  plain.push_back(static_cast<uint8_t>(crc >> 8));
  Bytes frame = Stuff(plain);
  frame.push_back(0);
  return frame;
}

std::optional<Bytes> DecodeFrame(std::span<const uint8_t> stuffed) {
  std::optional<Bytes> plain = Unstuff(stuffed);
  if (!plain || plain->size() < 3 || plain->size() > kMaxPayloadBytes + 2) return std::nullopt;
  const size_t length = plain->size() - 2;
  const auto crc = static_cast<uint16_t>((*plain)[length] | (*plain)[length + 1] << 8);
  if (crc != Crc16(std::span(*plain).first(length))) return std::nullopt;
  plain->resize(length);
  return plain;
}

void FrameSplitter::Feed(std::span<const uint8_t> bytes, std::vector<Bytes>& payloads) {
  for (const uint8_t byte : bytes) {
    if (byte == 0) {
      EndFrame(payloads);
    } else if (pending_.size() < kMaxStuffedBytes) {
      pending_.push_back(byte);
    } else {
      overlong_ = true;
    }
  }
}

void FrameSplitter::EndFrame(std::vector<Bytes>& payloads) {
  std::optional<Bytes> payload;
  if (!overlong_) payload = DecodeFrame(pending_);
  if (payload) {
    payloads.push_back(*std::move(payload));
  } else if (joined_ && !pending_.empty()) {
    ++damaged_;
  }
  joined_ = true;
  overlong_ = false;
  pending_.clear();
}

}  // namespace eyebox::capture::serial
