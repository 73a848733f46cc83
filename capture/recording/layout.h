// Where things lie in a recording's folder.
#ifndef EYEBOX_CAPTURE_RECORDING_LAYOUT_H_
#define EYEBOX_CAPTURE_RECORDING_LAYOUT_H_

#include <filesystem>

namespace eyebox::capture {

constexpr int kFormatVersion = 1;

std::filesystem::path HeaderPath(const std::filesystem::path& recording);
std::filesystem::path ManifestPath(const std::filesystem::path& recording);
std::filesystem::path CapturesFolder(const std::filesystem::path& recording);
// captures/000001.h5 for number 1.
std::filesystem::path CapturePath(const std::filesystem::path& recording, int number);
// The same with .partial behind: a capture that is not published.
std::filesystem::path PartialPath(const std::filesystem::path& recording, int number);

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_RECORDING_LAYOUT_H_
