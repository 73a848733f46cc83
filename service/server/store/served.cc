#include "service/server/store/served.h"

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "capture/base/status.h"
#include "service/server/store/rig_names.h"

namespace eyebox::service {
namespace {

namespace fs = std::filesystem;

constexpr int kMostEntries = 100'000;
constexpr int kDeepest = 8;
constexpr char kHeader[] = "recording.textproto";

void AddRig(const std::string& path, Served& served) {
  if (!path.ends_with(kRigSuffix)) return;
  const std::string name = "rigs/" + path.substr(0, path.size() - kRigSuffix.size());
  if (CheckName(kRigNameRule, "name", name).ok()) served.rigs.push_back(name);
}

void AddRecording(const std::string& path, Served& served) {
  const std::string name = "recordings/" + path;
  if (CheckName(kRecordingNameRule, "name", name).ok()) served.recordings.push_back(name);
}

// One entry. Adds what it is, or says not to look into it.
void Look(const fs::path& root, fs::recursive_directory_iterator& entry, Served& served) {
  std::error_code ignored;
  const fs::path path = entry->path();
  const fs::file_status status = entry->symlink_status(ignored);
  const std::string relative = path.lexically_relative(root).generic_string();
  if (fs::is_regular_file(status)) return AddRig(relative, served);
  if (!fs::is_directory(status)) return;
  const bool recording = fs::is_regular_file(fs::symlink_status(path / kHeader, ignored));
  const bool hidden = path.filename().string().starts_with('.');
  if (recording && !hidden) AddRecording(relative, served);
  if (recording || hidden || entry.depth() + 1 >= kDeepest) entry.disable_recursion_pending();
}

}  // namespace

absl::StatusOr<Served> ListServed(const RootFolder& data) {
  Served served;
  std::error_code error;
  // With the slash, or the link of the descriptor itself would be looked at.
  const fs::path root = data.Path() / "";
  fs::recursive_directory_iterator entry(root, fs::directory_options::skip_permission_denied,
                                         error);
  for (int seen = 0; !error && entry != fs::recursive_directory_iterator();
       entry.increment(error)) {
    if (++seen > kMostEntries) {
      return absl::ResourceExhaustedError(
          Complaint("the served folder", "holds more than 100000 files outside of recordings",
                    "serve a folder of recordings and rig files alone"));
    }
    Look(root, entry, served);
  }
  if (error) return SystemFailed("the served folder", error.value(), "check its disk");
  std::ranges::sort(served.recordings);
  std::ranges::sort(served.rigs);
  return served;
}

}  // namespace eyebox::service
