#include "capture/camera/v4l2/video_controls.h"

#include <errno.h>
#include <linux/videodev2.h>

#include "capture/base/status.h"

namespace eyebox::capture {
namespace {

absl::Status Stays(const VideoNode& node, const Control& control, int32_t value, int32_t wanted) {
  return DeviceFailed(node.path() + " control '" + control.name + "'",
                      "stays at " + std::to_string(value) + " instead of " + std::to_string(wanted),
                      "end the program that holds it, or use a camera that lets it be set");
}

}  // namespace

absl::StatusOr<std::optional<Control>> FindControl(const VideoNode& node, uint32_t id) {
  v4l2_queryctrl query = {};
  query.id = id;
  const int error_number = node.TryIoctl(VIDIOC_QUERYCTRL, &query);
  if (error_number == EINVAL || error_number == ENOTTY) return std::nullopt;
  if (error_number != 0) return node.Failed("describe its controls", error_number);
  if ((query.flags & V4L2_CTRL_FLAG_DISABLED) != 0) return std::nullopt;
  const std::string_view name(reinterpret_cast<const char*>(query.name), sizeof query.name);
  return Control{.id = id,
                 .name = std::string(name.substr(0, name.find('\0'))),
                 .minimum = query.minimum,
                 .maximum = query.maximum,
                 .step = query.step > 0 ? query.step : 1,
                 .default_value = query.default_value,
                 .read_only = (query.flags & V4L2_CTRL_FLAG_READ_ONLY) != 0};
}

absl::StatusOr<int32_t> ReadControl(const VideoNode& node, const Control& control) {
  v4l2_control value = {.id = control.id, .value = 0};
  EYEBOX_RETURN_IF_ERROR(
      node.Ioctl(VIDIOC_G_CTRL, &value, "read its control '" + control.name + "'"));
  return value.value;
}

absl::StatusOr<int32_t> WriteControl(const VideoNode& node, const Control& control, int32_t value) {
  if (!control.read_only) {
    v4l2_control write = {.id = control.id, .value = value};
    EYEBOX_RETURN_IF_ERROR(
        node.Ioctl(VIDIOC_S_CTRL, &write,
                   "set its control '" + control.name + "' to " + std::to_string(value)));
  }
  return ReadControl(node, control);
}

absl::StatusOr<Control> FindExposureControl(const VideoNode& node) {
  EYEBOX_ASSIGN_OR_RETURN(const auto exposure, FindControl(node, V4L2_CID_EXPOSURE_ABSOLUTE));
  if (exposure) return *exposure;
  return DeviceFailed(node.path(), "(" + node.card() + ") has no exposure control in units of time",
                      "use a camera whose driver has V4L2_CID_EXPOSURE_ABSOLUTE");
}

absl::StatusOr<std::optional<Control>> FindGainControl(const VideoNode& node) {
  EYEBOX_ASSIGN_OR_RETURN(auto gain, FindControl(node, V4L2_CID_ANALOGUE_GAIN));
  if (gain) return gain;
  return FindControl(node, V4L2_CID_GAIN);
}

absl::StatusOr<std::optional<Control>> FindBlackLevelControl(const VideoNode& node) {
  EYEBOX_ASSIGN_OR_RETURN(auto black_level, FindControl(node, V4L2_CID_BLACK_LEVEL));
  if (black_level) return black_level;
  return FindControl(node, V4L2_CID_BRIGHTNESS);
}

void WatchControls(const VideoNode& node, std::span<const HeldControl> held) {
  v4l2_event_subscription all = {};  // what is pending from before goes with it
  all.type = V4L2_EVENT_ALL;
  node.TryIoctl(VIDIOC_UNSUBSCRIBE_EVENT, &all);
  for (const HeldControl& one : held) {
    v4l2_event_subscription subscription = {};
    subscription.type = V4L2_EVENT_CTRL;
    subscription.id = one.control.id;
    subscription.flags = V4L2_EVENT_SUB_FL_SEND_INITIAL;  // shows what changed before this call
    node.TryIoctl(VIDIOC_SUBSCRIBE_EVENT, &subscription);
  }
}

absl::Status CheckWatched(const VideoNode& node, std::span<const HeldControl> held) {
  v4l2_event event = {};
  while (node.TryIoctl(VIDIOC_DQEVENT, &event) == 0) {
    if (event.type != V4L2_EVENT_CTRL) continue;
    if ((event.u.ctrl.changes & V4L2_EVENT_CTRL_CH_VALUE) == 0) continue;
    for (const HeldControl& one : held) {
      if (one.control.id == event.id && event.u.ctrl.value != one.value) {
        return Stays(node, one.control, event.u.ctrl.value, one.value);
      }
    }
  }
  return absl::OkStatus();
}

}  // namespace eyebox::capture
