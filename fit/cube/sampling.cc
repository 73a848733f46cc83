#include "fit/cube/sampling.h"

#include <algorithm>
#include <cmath>

#include "optics/render/log_c.h"
#include "optics/render/srgb.h"

namespace eyebox::fit {

double PositionOf(TableTarget target, int size, double u) {
  const double axis =
      target == TableTarget::kHdrp ? optics::LinearToLogC(u) : std::clamp(u, 0.0, 1.0);
  const double position = axis * (size - 1);
  return target == TableTarget::kPtb ? std::round(position) : position;
}

double UAtPosition(TableTarget target, int size, double position) {
  const double axis = position / (size - 1);
  return target == TableTarget::kHdrp ? optics::LogCToLinear(axis) : axis;
}

double LargestU(TableTarget target) {
  return target == TableTarget::kHdrp ? optics::LogCToLinear(1) : 1;
}

double Interpolate(std::span<const double> entries, double position) {
  const double last_interval = static_cast<double>(entries.size()) - 2;
  const double below = std::clamp(std::floor(position), 0.0, last_interval);
  const size_t i = static_cast<size_t>(below);
  return std::lerp(entries[i], entries[i + 1], position - below);
}

double EntryOfDrive(TableTarget target, double drive) {
  return target == TableTarget::kHdrp ? optics::SrgbToLinear(drive) : drive;
}

double DriveOfEntry(TableTarget target, double entry) {
  const double drive = target == TableTarget::kHdrp ? optics::LinearToSrgb(entry) : entry;
  return std::clamp(drive, 0.0, 1.0);
}

}  // namespace eyebox::fit
