// When the files of a recording were touched last.
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include "absl/strings/str_cat.h"
#include "capture/recording/checksum.h"
#include "service/server/catalogue/describe.h"
#include "service/server/store/served.h"

namespace eyebox::service {
namespace {

namespace fs = std::filesystem;

constexpr int64_t kNsPerS = 1'000'000'000;
// The kernel stamps files with a clock that advances every 10 ms at the slowest.
constexpr int64_t kSettledNs = 20'000'000;
constexpr int kDeepest = 2;  // captures/000001.h5 and results/NAME

class Census {
 public:
  // False where something cannot be looked at.
  bool Add(const fs::path& path, const std::string& name, int depth) {
    struct stat status = {};
    if (lstat(path.c_str(), &status) != 0) return false;
    const int64_t changed_ns = status.st_ctim.tv_sec * kNsPerS + status.st_ctim.tv_nsec;
    newest_ns_ = std::max(newest_ns_, changed_ns);
    lines_.push_back(absl::StrCat(name, " ", status.st_mode, " ", status.st_dev, " ", status.st_ino,
                                  " ", status.st_size, " ", changed_ns, "\n"));
    return !S_ISDIR(status.st_mode) || depth == kDeepest || AddEntries(path, name, depth + 1);
  }

  int64_t newest_ns() const { return newest_ns_; }

  // The same in whatever order a folder lists its entries.
  uint64_t Checksum() {
    std::ranges::sort(lines_);
    std::string all;
    for (const std::string& line : lines_) all += line;
    return capture::Checksum(all);
  }

 private:
  bool AddEntries(const fs::path& folder, const std::string& name, int depth) {
    std::error_code error;
    // With the slash, or the link of a descriptor itself would be listed.
    for (fs::directory_iterator entry(folder / "", error);
         !error && entry != fs::directory_iterator(); entry.increment(error)) {
      const std::string below = absl::StrCat(name, "/", entry->path().filename().string());
      if (!Add(entry->path(), below, depth)) return false;
    }
    return !error;
  }

  int64_t newest_ns_ = 0;
  std::vector<std::string> lines_;
};

}  // namespace

std::string StampOf(const RootFolder& data, const std::string& name, int64_t now_real_ns) {
  const std::string path = name.substr(std::min(name.size(), kRecordingNameRule.prefix.size()));
  Census census;
  if (!census.Add(data.Path() / path, "", 0)) return "";
  if (census.newest_ns() + kSettledNs > now_real_ns) return "";
  return absl::StrCat(absl::Hex(census.Checksum(), absl::kZeroPad16));
}

}  // namespace eyebox::service
