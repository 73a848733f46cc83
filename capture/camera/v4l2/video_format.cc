#include "capture/camera/v4l2/video_format.h"

#include <errno.h>
#include <linux/videodev2.h>

#include <algorithm>
#include <optional>
#include <string>

#include "capture/base/status.h"

namespace eyebox::capture {
namespace {

constexpr uint32_t kMaxEntries = 1000;  // a list that does not end is the driver's fault

std::string ToText(ImageSize size) {
  return std::to_string(size.width_px) + "x" + std::to_string(size.height_px);
}

std::string NamesOf(const std::vector<V4l2Format>& formats) {
  std::string names;
  for (const V4l2Format& format : formats)
    names.append(names.empty() ? "" : " ").append(format.name);
  return names.empty() ? "nothing raw" : names;
}

absl::StatusOr<V4l2Format> ChooseFormat(const VideoNode& node, const V4l2Options& options) {
  EYEBOX_ASSIGN_OR_RETURN(const std::vector<V4l2Format> offered, OfferedFormats(node));
  const V4l2Format* best = nullptr;
  for (const V4l2Format& format : offered) {
    if (options.format.empty()) {
      if (best == nullptr || format.significant_bits > best->significant_bits) best = &format;
    } else if (format.name == options.format) {
      best = &format;
    }
  }
  if (best != nullptr) return *best;
  return BadInput(options.uri + " format",
                  options.format.empty() ? "cannot be chosen: every format is processed"
                                         : "is " + options.format + ", which is not offered",
                  "this camera offers " + NamesOf(offered));
}

// The largest size offered; empty where the driver lists none.
std::optional<ImageSize> LargestSize(const VideoNode& node, uint32_t fourcc) {
  std::optional<ImageSize> largest;
  for (uint32_t i = 0; i < kMaxEntries; ++i) {
    v4l2_frmsizeenum entry = {};
    entry.index = i;
    entry.pixel_format = fourcc;
    if (node.TryIoctl(VIDIOC_ENUM_FRAMESIZES, &entry) != 0) break;
    const bool discrete = entry.type == V4L2_FRMSIZE_TYPE_DISCRETE;
    const ImageSize size = {
        .width_px = static_cast<int>(discrete ? entry.discrete.width : entry.stepwise.max_width),
        .height_px =
            static_cast<int>(discrete ? entry.discrete.height : entry.stepwise.max_height)};
    if (!largest || size.PixelCount() > largest->PixelCount()) largest = size;
    if (!discrete) break;
  }
  return largest;
}

// The two layouts of struct v4l2_format behind one view.
struct Answer {
  uint32_t fourcc;
  ImageSize size;
  uint32_t field;
  uint32_t planes;
  uint32_t stride_bytes;
  uint32_t image_bytes;
};

Answer Read(const VideoNode& node, const v4l2_format& format) {
  const auto size = [](uint32_t width, uint32_t height) {
    return ImageSize{.width_px = static_cast<int>(width), .height_px = static_cast<int>(height)};
  };
  if (node.multiplanar()) {
    const v4l2_pix_format_mplane& pix = format.fmt.pix_mp;
    return {pix.pixelformat, size(pix.width, pix.height),   pix.field,
            pix.num_planes,  pix.plane_fmt[0].bytesperline, pix.plane_fmt[0].sizeimage};
  }
  const v4l2_pix_format& pix = format.fmt.pix;
  return {pix.pixelformat, size(pix.width, pix.height), pix.field, 1, pix.bytesperline,
          pix.sizeimage};
}

void Write(const VideoNode& node, uint32_t fourcc, ImageSize size, v4l2_format& format) {
  if (node.multiplanar()) {
    v4l2_pix_format_mplane& pix = format.fmt.pix_mp;
    pix = {};
    pix.pixelformat = fourcc;
    pix.width = static_cast<uint32_t>(size.width_px);
    pix.height = static_cast<uint32_t>(size.height_px);
    pix.field = V4L2_FIELD_NONE;
    pix.num_planes = 1;
  } else {
    v4l2_pix_format& pix = format.fmt.pix;
    pix = {};
    pix.pixelformat = fourcc;
    pix.width = static_cast<uint32_t>(size.width_px);
    pix.height = static_cast<uint32_t>(size.height_px);
    pix.field = V4L2_FIELD_NONE;
  }
}

absl::Status Altered(const VideoNode& node, const std::string& what, const std::string& remedy) {
  return DeviceFailed(node.path() + " format", what, remedy);
}

absl::StatusOr<VideoFormat> Compare(const VideoNode& node, const V4l2Format& pixel, ImageSize size,
                                    const Answer& answer) {
  const std::string asked = std::string(pixel.name) + " " + ToText(size);
  if (answer.fourcc != pixel.fourcc || answer.size != size) {
    return Altered(node,
                   "was asked to be " + asked + " and became " + FourccName(answer.fourcc) + " " +
                       ToText(answer.size),
                   "name one in the URI that the camera keeps (format=..., size=...)");
  }
  if (answer.field != V4L2_FIELD_NONE || answer.planes != 1) {
    return Altered(node, asked + " came interlaced or in several planes",
                   "use a format with one plane of whole frames");
  }
  const size_t row_bytes = PackedBytes(pixel.packing, static_cast<size_t>(size.width_px));
  const size_t stride_bytes = answer.stride_bytes == 0 ? row_bytes : answer.stride_bytes;
  const size_t image_bytes = stride_bytes * static_cast<size_t>(size.height_px - 1) + row_bytes;
  if (stride_bytes >= row_bytes && answer.image_bytes >= image_bytes) {
    return VideoFormat{pixel, size, stride_bytes, image_bytes};
  }
  return Altered(node,
                 asked + " has rows of " + std::to_string(answer.stride_bytes) +
                     " bytes in images of " + std::to_string(answer.image_bytes) +
                     " bytes, too small to hold it",
                 "choose another format or size; the driver contradicts itself");
}

double ToSeconds(const v4l2_fract& interval) {
  return interval.denominator == 0 ? 0
                                   : static_cast<double>(interval.numerator) / interval.denominator;
}

absl::StatusOr<double> CurrentInterval(const VideoNode& node) {
  v4l2_streamparm parameters = {};
  parameters.type = node.buffer_type();
  const int error_number = node.TryIoctl(VIDIOC_G_PARM, &parameters);
  const double interval_s = ToSeconds(parameters.parm.capture.timeperframe);
  if (error_number == 0 && interval_s > 0) return interval_s;
  if (error_number == ENODEV) return node.Failed("tell its frame interval", error_number);
  return DeviceFailed(node.path(), "(" + node.card() + ") does not tell its frame interval",
                      "use a camera whose driver does; without it nobody knows which frame is the "
                      "first with a new exposure");
}

}  // namespace

absl::StatusOr<std::vector<V4l2Format>> OfferedFormats(const VideoNode& node) {
  std::vector<V4l2Format> offered;
  for (uint32_t i = 0; i < kMaxEntries; ++i) {
    v4l2_fmtdesc entry = {};
    entry.index = i;
    entry.type = node.buffer_type();
    const int error_number = node.TryIoctl(VIDIOC_ENUM_FMT, &entry);
    if (error_number == EINVAL || error_number == ENOTTY) break;
    if (error_number != 0) return node.Failed("list its formats", error_number);
    if ((entry.flags & (V4L2_FMT_FLAG_EMULATED | V4L2_FMT_FLAG_COMPRESSED)) != 0) continue;
    if (const V4l2Format* known = FindV4l2Format(entry.pixelformat)) offered.push_back(*known);
  }
  std::stable_partition(offered.begin(), offered.end(), [](const V4l2Format& format) {
    return format.mosaic == BayerMosaic::kNone;
  });
  return offered;
}

absl::StatusOr<VideoFormat> SetVideoFormat(const VideoNode& node, const V4l2Options& options) {
  EYEBOX_ASSIGN_OR_RETURN(const V4l2Format pixel, ChooseFormat(node, options));
  v4l2_format format = {};
  format.type = node.buffer_type();
  EYEBOX_RETURN_IF_ERROR(node.Ioctl(VIDIOC_G_FMT, &format, "tell its format"));
  std::optional<ImageSize> size = options.size_px;
  if (!size) size = LargestSize(node, pixel.fourcc);
  if (!size) size = Read(node, format).size;
  Write(node, pixel.fourcc, *size, format);
  EYEBOX_RETURN_IF_ERROR(node.Ioctl(VIDIOC_S_FMT, &format, "set the format"));
  return Compare(node, pixel, *size, Read(node, format));
}

absl::StatusOr<FrameIntervals> OfferedIntervals(const VideoNode& node, const VideoFormat& format) {
  FrameIntervals offered;
  for (uint32_t i = 0; i < kMaxEntries; ++i) {
    v4l2_frmivalenum entry = {};
    entry.index = i;
    entry.pixel_format = format.pixel.fourcc;
    entry.width = static_cast<uint32_t>(format.size.width_px);
    entry.height = static_cast<uint32_t>(format.size.height_px);
    if (node.TryIoctl(VIDIOC_ENUM_FRAMEINTERVALS, &entry) != 0) break;
    if (entry.type == V4L2_FRMIVAL_TYPE_DISCRETE) {
      offered.interval_s.push_back(ToSeconds(entry.discrete));
      continue;
    }
    offered.interval_s = {ToSeconds(entry.stepwise.min), ToSeconds(entry.stepwise.max)};
    offered.continuous = true;
    break;
  }
  if (offered.interval_s.empty()) {
    EYEBOX_ASSIGN_OR_RETURN(const double current_s, CurrentInterval(node));
    offered.interval_s = {current_s};
  }
  std::ranges::sort(offered.interval_s);
  return offered;
}

absl::StatusOr<double> SetFrameInterval(const VideoNode& node, const FrameIntervals& offered,
                                        double exposure_s) {
  const auto fits = std::ranges::lower_bound(offered.interval_s, exposure_s);
  if (fits == offered.interval_s.end()) {
    return BadInput(node.path() + " exposure_s", "is " + std::to_string(exposure_s),
                    "the longest frame interval of this format is " +
                        std::to_string(offered.LongestS()) + " s");
  }
  const double wanted_s = offered.continuous ? std::max(exposure_s, offered.interval_s[0]) : *fits;
  v4l2_streamparm parameters = {};
  parameters.type = node.buffer_type();
  parameters.parm.capture.timeperframe = {
      .numerator = static_cast<uint32_t>(std::min(wanted_s * 1e6 + 0.5, 4e9)),
      .denominator = 1000000};
  const int error_number = node.TryIoctl(VIDIOC_S_PARM, &parameters);
  if (error_number != 0 && error_number != ENOTTY && error_number != EINVAL) {
    return node.Failed("set its frame interval", error_number);
  }
  EYEBOX_ASSIGN_OR_RETURN(const double interval_s, CurrentInterval(node));
  constexpr double kRounding = 1e-3;  // of drivers that count in microseconds or in 1/fps
  if (interval_s >= exposure_s * (1 - kRounding)) return interval_s;
  return DeviceFailed(node.path(),
                      "runs at a frame interval of " + std::to_string(interval_s) +
                          " s, too short for an exposure of " + std::to_string(exposure_s) + " s",
                      "ask for a shorter exposure");
}

}  // namespace eyebox::capture
