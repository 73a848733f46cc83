// How messages lie on the wire: payload and CRC, byte-stuffed (COBS, Cheshire & Baker 1999), ended
// by a zero. Whatever is damaged costs its own frame and no other. Grammar: ../arduino/README.md.
#ifndef EYEBOX_CAPTURE_PHOTODIODE_SERIAL_FRAMING_H_
#define EYEBOX_CAPTURE_PHOTODIODE_SERIAL_FRAMING_H_

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace eyebox::capture::serial {

using Bytes = std::vector<uint8_t>;

inline constexpr size_t kMaxPayloadBytes = 128;

// CRC-16/CCITT-FALSE: polynomial 0x1021, start 0xffff, not reflected; of "123456789" 0x29b1.
uint16_t Crc16(std::span<const uint8_t> bytes);

// Payload (1 to kMaxPayloadBytes) -> bytes on the wire, the final zero included.
Bytes EncodeFrame(std::span<const uint8_t> payload);

// What stands between two zeros -> payload; empty if it is damaged (stuffing, length or CRC).
std::optional<Bytes> DecodeFrame(std::span<const uint8_t> stuffed);

// Cuts a stream of bytes into payloads. Bounded memory on any input. Not thread-safe.
class FrameSplitter {
 public:
  // Appends the payloads that are complete with these bytes to `payloads`.
  void Feed(std::span<const uint8_t> bytes, std::vector<Bytes>& payloads);

  // Frames that were there and could not be read. The piece before the first zero does not count:
  // one joins in the middle.
  uint64_t damaged() const { return damaged_; }

 private:
  void EndFrame(std::vector<Bytes>& payloads);

  Bytes pending_;
  bool overlong_ = false;
  bool joined_ = false;  // a zero was seen
  uint64_t damaged_ = 0;
};

}  // namespace eyebox::capture::serial

#endif  // EYEBOX_CAPTURE_PHOTODIODE_SERIAL_FRAMING_H_
