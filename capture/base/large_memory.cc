#include "capture/base/large_memory.h"

#include <sys/mman.h>

#include <cstddef>
#include <mutex>
#include <new>
#include <vector>

namespace eyebox {
namespace {

constexpr size_t kHugePage = size_t{2} << 20;
constexpr size_t kHugeBytes = 2 * kHugePage;
constexpr size_t kPage = size_t{4} << 10;
// Smaller blocks are the allocator's business; those above it hands back to the kernel at once.
constexpr size_t kLeastKeptBytes = size_t{64} << 10;
// Ten 12-megapixel images in single precision.
constexpr size_t kMostKeptBytes = size_t{512} << 20;
constexpr size_t kMostKeptBlocks = 128;

size_t WholePages(size_t bytes) {
  const size_t page = bytes < kHugeBytes ? kPage : kHugePage;
  return (bytes + page - 1) / page * page;
}

void* FreshBlock(size_t whole) {
  if (whole < kHugeBytes) return ::operator new(whole);
  void* const block = ::operator new(whole, std::align_val_t(kHugePage));
  // A kernel without huge pages refuses; the memory is as good, only slower.
  madvise(block, whole, MADV_HUGEPAGE);
  return block;
}

void Delete(void* block, size_t whole) {
  if (whole < kHugeBytes) {
    ::operator delete(block);
  } else {
    ::operator delete(block, std::align_val_t(kHugePage));
  }
}

// Blocks that were given back, for others of the same size: the kernel clears fresh pages, which
// takes longer than most of what is done with an image.
class KeptBlocks {
 public:
  void* Take(size_t bytes) {
    const std::scoped_lock lock(mutex_);
    for (size_t i = blocks_.size(); i-- > 0;) {
      if (blocks_[i].bytes != bytes) continue;
      void* const memory = blocks_[i].memory;
      blocks_.erase(blocks_.begin() + static_cast<std::ptrdiff_t>(i));
      kept_bytes_ -= bytes;
      return memory;
    }
    return nullptr;
  }

  void Keep(void* memory, size_t bytes) {
    const std::scoped_lock lock(mutex_);
    blocks_.push_back({memory, bytes});
    kept_bytes_ += bytes;
    while (kept_bytes_ > kMostKeptBytes || blocks_.size() > kMostKeptBlocks) {
      Delete(blocks_.front().memory, blocks_.front().bytes);
      kept_bytes_ -= blocks_.front().bytes;
      blocks_.erase(blocks_.begin());
    }
  }

 private:
  struct Block {
    void* memory = nullptr;
    size_t bytes = 0;
  };

  std::mutex mutex_;
  std::vector<Block> blocks_;  // oldest first
  size_t kept_bytes_ = 0;
};

// Never destroyed: images of static lifetime are freed after everything else.
KeptBlocks& Kept() {
  static auto* const kept = new KeptBlocks;
  return *kept;
}

#if defined(__SANITIZE_ADDRESS__)
constexpr bool kKeepsBlocks =
    false;  // its search for uses after the end of an image needs them freed
#else
constexpr bool kKeepsBlocks = true;
#endif

}  // namespace

void* AllocateLarge(size_t bytes) {
  if (bytes < kLeastKeptBytes) return ::operator new(bytes);
  const size_t whole = WholePages(bytes);
  void* const kept = Kept().Take(whole);
  return kept != nullptr ? kept : FreshBlock(whole);
}

void FreeLarge(void* block, size_t bytes) {
  if (bytes < kLeastKeptBytes) {
    ::operator delete(block);
  } else if (kKeepsBlocks) {
    Kept().Keep(block, WholePages(bytes));
  } else {
    Delete(block, WholePages(bytes));
  }
}

}  // namespace eyebox
