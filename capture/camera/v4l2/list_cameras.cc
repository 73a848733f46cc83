#include <algorithm>
#include <system_error>
#include <utility>

#include "absl/status/status.h"
#include "capture/camera/v4l2/v4l2_camera.h"
#include "capture/camera/v4l2/video_controls.h"
#include "capture/camera/v4l2/video_format.h"
#include "capture/camera/v4l2/video_node.h"

namespace eyebox::capture {
namespace {

constexpr std::string_view kPrefix = "video";

// "video12" -> 12; -1 for every other name.
int NodeNumber(const std::string& name) {
  if (!name.starts_with(kPrefix)) return -1;
  const std::string digits = name.substr(kPrefix.size());
  const bool number = !digits.empty() && digits.size() < 9 &&
                      digits.find_first_not_of("0123456789") == std::string::npos;
  return number ? std::stoi(digits) : -1;
}

std::vector<std::string> NodesIn(const std::filesystem::path& folder) {
  std::vector<std::pair<int, std::string>> nodes;
  std::error_code error;  // a folder that cannot be read holds no camera
  for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    const int number = NodeNumber(entry->path().filename());
    if (number >= 0) nodes.emplace_back(number, entry->path());
  }
  std::ranges::sort(nodes);
  std::vector<std::string> paths;
  paths.reserve(nodes.size());
  for (auto& [number, path] : nodes) paths.push_back(std::move(path));
  return paths;
}

V4l2Listing Describe(const std::string& path, VideoSyscalls* syscalls) {
  V4l2Listing listing;
  listing.uri = "v4l2:" + path;
  const auto node = VideoNode::Open(path, syscalls);
  if (!node.ok()) {
    listing.problem = std::string(node.status().message());
    return listing;
  }
  listing.card = (*node)->card();
  listing.driver = (*node)->driver();
  listing.bus = (*node)->bus();
  const auto formats = OfferedFormats(**node);
  if (!formats.ok()) {
    listing.problem = std::string(formats.status().message());
    return listing;
  }
  for (const V4l2Format& format : *formats) listing.formats.emplace_back(format.name);
  if (formats->empty()) {
    listing.problem = "offers no raw format: every one is compressed or interpolated";
  } else if (const auto exposure = FindExposureControl(**node); !exposure.ok()) {
    listing.problem = std::string(exposure.status().message());
  }
  return listing;
}

}  // namespace

std::vector<V4l2Listing> ListV4l2Cameras(const std::filesystem::path& folder,
                                         VideoSyscalls* syscalls) {
  std::vector<V4l2Listing> listings;
  for (const std::string& path : NodesIn(folder)) listings.push_back(Describe(path, syscalls));
  return listings;
}

}  // namespace eyebox::capture
