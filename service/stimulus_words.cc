#include "service/stimulus_words.h"

#include "absl/strings/str_format.h"

namespace eyebox::service {
namespace {

std::string Drive(const Stimulus& stimulus) {
  if (!stimulus.drive) return "1";
  const DriveRgb& drive = *stimulus.drive;
  if (drive[0] == drive[1] && drive[1] == drive[2]) return absl::StrFormat("%g", drive[0]);
  return absl::StrFormat("(%g, %g, %g)", drive[0], drive[1], drive[2]);
}

}  // namespace

std::string WhatToShow(const CaptureSpec& spec) {
  if (spec.kind == FrameKind::kDark) return "cover the lens, so that no light reaches it";
  if (spec.kind == FrameKind::kFlat) {
    const std::string luminance =
        spec.luminance_cd_m2 ? absl::StrFormat(" of %g cd/m2", *spec.luminance_cd_m2) : "";
    return "put the uniform reference" + luminance + " before the lens";
  }
  const std::string drive = Drive(spec.stimulus);
  switch (spec.stimulus.pattern) {
    case StimulusPattern::kFullField:
      return "show a steady full field of drive " + drive;
    case StimulusPattern::kDisk:
      return absl::StrFormat("show a disk of %g deg and drive %s on drive 0",
                             spec.stimulus.diameter_deg, drive);
    case StimulusPattern::kBlackDisk:
      return absl::StrFormat("show a disk of %g deg and drive 0 on drive %s",
                             spec.stimulus.diameter_deg, drive);
    case StimulusPattern::kCheckerboard:
      return absl::StrFormat(
          "show a checkerboard of drive %s and 0, squares of %g deg, four of them meeting in the "
          "middle, the one above it to the left bright",
          drive, spec.stimulus.diameter_deg);
  }
  return "show the next stimulus";
}

bool IsSameScene(const CaptureSpec& one, const CaptureSpec& other) {
  return one.kind == other.kind && one.stimulus == other.stimulus &&
         one.luminance_cd_m2 == other.luminance_cd_m2;
}

}  // namespace eyebox::service
