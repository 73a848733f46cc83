#include "fit/cube/design_table.h"

#include <cmath>
#include <string>
#include <utility>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"
#include "fit/cube/certificate.h"
#include "fit/cube/goal.h"
#include "fit/cube/minimax.h"
#include "fit/cube/rounding.h"
#include "fit/cube/sampling.h"

namespace eyebox::fit {
namespace {

constexpr int kSmallestSize = 2;
constexpr int kLargestCube = 129;
constexpr int kLargestStrip = 32;
constexpr int kMostSamples = 10'000'000;

absl::Status CheckActivation(const Activation& activation) {
  const auto refuse = [](const char* field, double value, const char* remedy) {
    return BadInput(absl::StrCat("activation.", field), absl::StrCat("is ", value), remedy);
  };
  const double minimum = activation.minimum_luminance;
  if (!(minimum >= 0) || std::isinf(minimum)) {
    return refuse("minimum_luminance", minimum, "give a luminance of 0 or more");
  }
  const double range = activation.luminance_range;
  if (!(range > 0) || std::isinf(range)) {
    return refuse("luminance_range", range, "give a luminance above 0");
  }
  const double cutoff = activation.cutoff_drive;
  if (!(cutoff >= 0 && cutoff < 1)) {
    return refuse("cutoff_drive", cutoff, "give a drive value from 0 up to 1");
  }
  const double gamma = activation.gamma;
  if (gamma > 0 && std::isfinite(gamma)) return absl::OkStatus();
  return refuse("gamma", gamma, "give an exponent above 0");
}

absl::Status CheckSize(TableTarget target, int size) {
  const int largest = target == TableTarget::kPps ? kLargestStrip : kLargestCube;
  if (size >= kSmallestSize && size <= largest) return absl::OkStatus();
  return BadInput("table size",
                  absl::StrCat(size, " is outside ", kSmallestSize, " to ", largest, " for target ",
                               std::string(NameOf(target))),
                  "give the size of the project's grading table, 32 unless it was changed");
}

absl::Status CheckWhite(TableTarget target, double white_u) {
  const double largest = LargestU(target);
  if (white_u <= largest) return absl::OkStatus();
  return BadInput("DesignOptions.white_u",
                  absl::StrCat(white_u, " lies beyond ", largest,
                               ", the end of the axis of target ", std::string(NameOf(target))),
                  "let white stand for a smaller rendered value");
}

// What the file will hold, so that the certificate speaks of that.
std::vector<double> AsFloat32(std::vector<double> entries) {
  for (double& entry : entries) entry = static_cast<float>(entry);
  return entries;
}

}  // namespace

std::string_view NameOf(TableTarget target) {
  switch (target) {
    case TableTarget::kHdrp:
      return "hdrp";
    case TableTarget::kPps:
      return "pps";
    case TableTarget::kResolve:
      return "resolve";
  }
  return "unknown";
}

absl::StatusOr<TableTarget> TableTargetOf(std::string_view name) {
  for (TableTarget target : {TableTarget::kHdrp, TableTarget::kPps, TableTarget::kResolve}) {
    if (name == NameOf(target)) return target;
  }
  return BadInput("table target", "\"" + std::string(name) + "\" is none",
                  "give hdrp, pps or resolve");
}

absl::Status DesignOptions::Validate() const {
  if (!(white_u > 0) || std::isinf(white_u)) {
    return BadInput("DesignOptions.white_u", absl::StrCat("is ", white_u),
                    "give a rendered value above 0");
  }
  if (!(u_from > 0 && u_from < 1)) {
    return BadInput("DesignOptions.u_from", absl::StrCat("is ", u_from),
                    "give a fraction of white between 0 and 1");
  }
  if (samples >= 2 && samples <= kMostSamples) return absl::OkStatus();
  return BadInput("DesignOptions.samples", absl::StrCat("is ", samples),
                  absl::StrCat("give 2 to ", kMostSamples));
}

absl::StatusOr<TableDesign> DesignTable(const Activation& activation, TableTarget target, int size,
                                        const DesignOptions& options) {
  EYEBOX_RETURN_IF_ERROR(options.Validate());
  EYEBOX_RETURN_IF_ERROR(CheckActivation(activation));
  EYEBOX_RETURN_IF_ERROR(CheckSize(target, size));
  EYEBOX_RETURN_IF_ERROR(CheckWhite(target, options.white_u));
  TableDesign table;
  table.target = target;
  table.size = size;
  table.white_u = options.white_u;
  for (int i = 0; i < size; ++i) table.knots_u.push_back(UAtPosition(target, size, i));
  const std::vector<DesignPoint> points =
      DesignPoints(activation, target, size, options.white_u, options.u_from);
  std::vector<double> entries = MinimaxEntries(activation, target, size, options.white_u, points);
  table.entries = target == TableTarget::kPps ? RoundTo8Bits(activation, entries, points)
                                              : AsFloat32(std::move(entries));
  table.u_cutoff = CutoffOf(activation);
  table.certificate = Certify(table, activation, options);
  return table;
}

}  // namespace eyebox::fit
