#include "capture/recording/layout.h"

#include <string>

namespace eyebox::capture {

std::filesystem::path HeaderPath(const std::filesystem::path& recording) {
  return recording / "recording.textproto";
}

std::filesystem::path ManifestPath(const std::filesystem::path& recording) {
  return recording / "manifest.log";
}

std::filesystem::path CapturesFolder(const std::filesystem::path& recording) {
  return recording / "captures";
}

std::filesystem::path CapturePath(const std::filesystem::path& recording, int number) {
  constexpr size_t kDigits = 6;
  std::string name = std::to_string(number);
  if (name.size() < kDigits) name.insert(0, kDigits - name.size(), '0');
  return CapturesFolder(recording) / (name + ".h5");
}

std::filesystem::path PartialPath(const std::filesystem::path& recording, int number) {
  std::filesystem::path path = CapturePath(recording, number);
  path += ".partial";
  return path;
}

}  // namespace eyebox::capture
