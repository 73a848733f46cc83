#include "service/devices.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "capture/base/file.h"
#include "capture/camera/aravis/aravis_rig.h"
#include "capture/camera/sim/parameters.h"
#include "capture/camera/v4l2/v4l2_camera.h"
#include "capture/photodiode/sim/sim_photodiode.h"

namespace eyebox::service {
namespace {

using Devices = google::protobuf::RepeatedPtrField<v1::Device>;
using Path = std::filesystem::path;

void Add(Devices& devices, const std::string& uri, const std::string& description,
         const std::string& problem = "") {
  v1::Device& device = *devices.Add();
  device.set_uri(uri);
  device.set_description(description);
  device.set_problem(problem);
}

// Names in `folder` that begin so and go on, shorter ones first: gpiochip2 before gpiochip10.
std::vector<std::string> NamesIn(const Path& folder, std::string_view prefix) {
  std::vector<std::string> names;
  std::error_code error;  // a folder that is not there holds no device
  for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string name = entry->path().filename();
    if (name.starts_with(prefix) && name.size() > prefix.size()) names.push_back(name);
  }
  std::ranges::sort(names, [](const auto& a, const auto& b) {
    return a.size() != b.size() ? a.size() < b.size() : a < b;
  });
  return names;
}

std::string WhyClosed(const Path& node) {
  if (::access(node.c_str(), R_OK | W_OK) == 0) return "";
  return absl::StrCat(node.string(), ": ", std::strerror(errno),
                      "; give this user access to it (a group or a udev rule)");
}

void AddCameras(const DevicePlaces& places, Devices& cameras) {
  for (const std::string& name : capture::SimNames()) {
    Add(cameras, "sim:" + name, "simulated headset and camera");
  }
  if (places.ask_network) {
    for (const capture::CameraInfo& info : capture::ListAravisCameras()) {
      Add(cameras, info.uri, absl::StrJoin({info.vendor, info.model, info.serial}, " "));
    }
  }
  Add(cameras, "aravis:fake", "camera that Aravis simulates in this process");
  for (const capture::V4l2Listing& node : capture::ListV4l2Cameras(places.nodes)) {
    std::string description = absl::StrJoin({node.card, node.driver, node.bus}, " ");
    if (!node.formats.empty()) {
      absl::StrAppend(&description, ", ", absl::StrJoin(node.formats, " "));
    }
    Add(cameras, node.uri, std::string(absl::StripAsciiWhitespace(description)), node.problem);
  }
}

// "in_voltage0_raw" -> "voltage0"; empty for what is no channel to convert.
std::string ChannelOf(std::string_view file) {
  constexpr std::string_view kPrefix = "in_";
  constexpr std::string_view kSuffix = "_raw";
  if (!file.starts_with(kPrefix) || !file.ends_with(kSuffix)) return "";
  return std::string(file.substr(kPrefix.size(), file.size() - kPrefix.size() - kSuffix.size()));
}

void AddPhotodiodes(const DevicePlaces& places, Devices& photodiodes) {
  for (const std::string& device : NamesIn(places.iio, "iio:device")) {
    const auto name = ReadWholeFile(places.iio / device / "name");
    if (!name.ok()) continue;  // it went away meanwhile
    const std::string label(absl::StripAsciiWhitespace(*name));
    for (const std::string& file : NamesIn(places.iio / device, "in_")) {
      const std::string channel = ChannelOf(file);
      if (channel.empty()) continue;
      Add(photodiodes, absl::StrCat("iio:", label, "/", channel), device,
          WhyClosed(places.nodes / device));
    }
  }
  for (const char* kind : {"ttyACM", "ttyUSB"}) {
    for (const std::string& port : NamesIn(places.nodes, kind)) {
      Add(photodiodes, absl::StrCat("serial:", (places.nodes / port).string()),
          "serial port; an Arduino with the photodiode's sketch may be behind it",
          WhyClosed(places.nodes / port));
    }
  }
  for (const std::string& name : capture::SimPhotodiodeNames()) {
    Add(photodiodes, "sim:" + name, "simulated photodiode");
  }
}

void AddTriggers(const DevicePlaces& places, Devices& triggers) {
  for (const std::string& chip : NamesIn(places.nodes, "gpiochip")) {
    Add(triggers, chip + ":LINE", "GPIO chip; LINE is the number or the name of a line",
        WhyClosed(places.nodes / chip));
  }
}

}  // namespace

v1::DevicesResult ListDevices(const DevicePlaces& places) {
  v1::DevicesResult result;
  AddCameras(places, *result.mutable_cameras());
  AddPhotodiodes(places, *result.mutable_photodiodes());
  AddTriggers(places, *result.mutable_triggers());
  return result;
}

}  // namespace eyebox::service
