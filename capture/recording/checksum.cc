#include "capture/recording/checksum.h"

#include <xxhash.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "capture/base/status.h"

namespace eyebox::capture {
namespace {

constexpr uint64_t kPieceBytes = 1 << 20;

struct StateFree {
  void operator()(XXH3_state_t* state) const { XXH3_freeState(state); }
};

absl::Status AddRange(const UnixFile& file, uint64_t begin, uint64_t end, XXH3_state_t* state,
                      std::vector<char>& piece) {
  while (begin < end) {
    const size_t size = std::min(kPieceBytes, end - begin);
    EYEBOX_RETURN_IF_ERROR(file.ReadAt(begin, piece.data(), size));
    XXH3_64bits_update(state, piece.data(), size);
    begin += size;
  }
  return absl::OkStatus();
}

}  // namespace

uint64_t Checksum(const void* data, size_t size) { return XXH3_64bits(data, size); }

absl::StatusOr<uint64_t> ChecksumOutside(const UnixFile& file, std::span<const ByteRange> skipped) {
  EYEBOX_ASSIGN_OR_RETURN(const uint64_t end, file.Size());
  const std::unique_ptr<XXH3_state_t, StateFree> state(XXH3_createState());
  XXH3_64bits_reset(state.get());
  std::vector<char> piece(kPieceBytes);
  uint64_t begin = 0;
  for (const ByteRange& range : skipped) {
    EYEBOX_RETURN_IF_ERROR(AddRange(file, begin, std::min(range.offset, end), state.get(), piece));
    begin = range.offset + range.size;
  }
  EYEBOX_RETURN_IF_ERROR(AddRange(file, begin, end, state.get(), piece));
  return XXH3_64bits_digest(state.get());
}

}  // namespace eyebox::capture
