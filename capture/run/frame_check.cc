#include "capture/run/frame_check.h"

#include <cmath>
#include <string>

#include "capture/base/status.h"

namespace eyebox::capture {
namespace {

constexpr double kGainToleranceDb = 1e-3;

std::string NameOf(BufferStatus status) {
  switch (status) {
    case BufferStatus::kComplete:
      return "is complete";
    case BufferStatus::kMissingPackets:
      return "misses packets";
    case BufferStatus::kTimedOut:
      return "timed out";
    case BufferStatus::kDeviceError:
      return "carries a device error";
    case BufferStatus::kAborted:
      return "was aborted";
  }
  return "has an unknown status";
}

bool SameExposure(double reported_s, double asked_s, double tolerance) {
  return std::abs(reported_s - asked_s) <= tolerance * asked_s;
}

absl::Status CheckOrder(uint64_t id, uint64_t previous_id) {
  if (id == previous_id + 1) return absl::OkStatus();
  const std::string came =
      "frame " + std::to_string(id) + " came after frame " + std::to_string(previous_id);
  if (id > previous_id) return Spoilt(came + ": the frames between were dropped");
  return Spoilt(came + ": it came twice or late");
}

absl::Status CheckReported(const FrameMetadata& metadata, const CaptureSpec& spec,
                           double tolerance) {
  const std::string frame = "frame " + std::to_string(metadata.camera_frame_id);
  if (metadata.exposure_reported_s &&
      !SameExposure(*metadata.exposure_reported_s, spec.exposure_s, tolerance)) {
    return Spoilt(frame + " reports an exposure of " +
                  std::to_string(*metadata.exposure_reported_s) + " s instead of " +
                  std::to_string(spec.exposure_s) + " s");
  }
  if (metadata.gain_reported_db &&
      std::abs(*metadata.gain_reported_db - spec.gain_db) > kGainToleranceDb) {
    return Spoilt(frame + " reports a gain of " + std::to_string(*metadata.gain_reported_db) +
                  " dB instead of " + std::to_string(spec.gain_db) + " dB");
  }
  return absl::OkStatus();
}

}  // namespace

absl::Status Spoilt(const std::string& what) { return absl::AbortedError(what); }

absl::Status CheckFrame(const FrameMetadata& metadata, const CaptureSpec& spec,
                        std::optional<uint64_t> previous_id, double tolerance) {
  if (metadata.status != BufferStatus::kComplete) {
    return Spoilt("frame " + std::to_string(metadata.camera_frame_id) + " " +
                  NameOf(metadata.status));
  }
  if (previous_id) EYEBOX_RETURN_IF_ERROR(CheckOrder(metadata.camera_frame_id, *previous_id));
  return CheckReported(metadata, spec, tolerance);
}

absl::Status CheckReadBack(const CameraSettings& asked, const CameraSettings& set,
                           const std::string& uri, double tolerance) {
  if (SameExposure(set.exposure_s, asked.exposure_s, tolerance) &&
      std::abs(set.gain_db - asked.gain_db) <= kGainToleranceDb) {
    return absl::OkStatus();
  }
  return DeviceFailed(uri,
                      "was asked for " + std::to_string(asked.exposure_s) + " s, " +
                          std::to_string(asked.gain_db) + " dB and reads back " +
                          std::to_string(set.exposure_s) + " s, " + std::to_string(set.gain_db) +
                          " dB",
                      "plan exposures and gains that the camera can hold");
}

}  // namespace eyebox::capture
