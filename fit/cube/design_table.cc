#include "fit/cube/design_table.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"
#include "fit/cube/certificate.h"
#include "fit/cube/goal.h"
#include "fit/cube/minimax.h"
#include "fit/cube/published.h"
#include "fit/cube/rounding.h"
#include "fit/cube/sampling.h"
#include "fit/cube/stored_minimax.h"

namespace eyebox::fit {
namespace {

constexpr int kSmallestSize = 2;
constexpr int kLargestCube = 129;
constexpr int kLargestStrip = 32;
constexpr int kGammaTable = 256;
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

absl::Status CheckSize(TableTarget target, DesignMethod method, int size) {
  if (target == TableTarget::kPtb && size != kGammaTable) {
    return BadInput("table size", absl::StrCat(size, " is not 256"),
                    "target ptb has one entry for each 8-bit value: give size 256");
  }
  if (target == TableTarget::kHdrp && method == DesignMethod::kPublished &&
      size != kPublishedSize) {
    return BadInput("table size",
                    absl::StrCat(size, " has no published knots, only ", kPublishedSize),
                    "give size 32 or design by minimax");
  }
  const int largest = target == TableTarget::kPps ? kLargestStrip : kLargestCube;
  if (target == TableTarget::kPtb || (size >= kSmallestSize && size <= largest)) {
    return absl::OkStatus();
  }
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

// What takes part in the design, so that no one believes what was not done.
absl::Status CheckDesignedFor(TableTarget target, const DesignOptions& options) {
  if (options.designed_for.IsExact()) return absl::OkStatus();
  EYEBOX_RETURN_IF_ERROR(CheckStorage(target, options.designed_for));
  const bool can = target == TableTarget::kHdrp || target == TableTarget::kResolve;
  if (can && options.method == DesignMethod::kMinimax) return absl::OkStatus();
  return BadInput("DesignOptions.designed_for",
                  absl::StrCat(NameOf(options.designed_for), " is not taken into account by ",
                               std::string(NameOf(options.method)), " tables for ",
                               std::string(NameOf(target))),
                  "certify the finished table after that storage instead");
}

// What the file will hold, so that the certificate speaks of that.
std::vector<double> AsFloat32(std::vector<double> entries) {
  for (double& entry : entries) entry = static_cast<float>(entry);
  return entries;
}

std::vector<double> Designed(const Activation& activation, const TableDesign& table,
                             const DesignOptions& options) {
  if (table.target == TableTarget::kPtb) {
    std::vector<double> entries = IdealEntries(activation, table.target, table.size, table.white_u);
    for (double& entry : entries) entry = std::min(entry, 1.0);
    return entries;
  }
  const std::vector<DesignPoint> points =
      DesignPoints(activation, table.target, table.size, table.white_u, options.u_from);
  std::vector<double> entries =
      MinimaxEntries(activation, table.target, table.size, table.white_u, points);
  if (table.target == TableTarget::kPps) return RoundTo8Bits(activation, entries, points);
  if (options.designed_for.IsExact()) return entries;
  return StoredMinimaxEntries(activation, table.target, table.white_u, options.u_from,
                              options.designed_for, std::move(entries));
}

std::vector<double> Published(const Activation& activation, const TableDesign& table) {
  std::vector<double> entries =
      PublishedEntries(activation, table.target, table.size, table.white_u);
  const bool is_strip = table.target == TableTarget::kPps;
  for (double& entry : entries) {
    if (is_strip || table.target == TableTarget::kPtb) entry = std::min(entry, 1.0);
    if (is_strip) entry = std::round(255 * entry) / 255;
  }
  return entries;
}

}  // namespace

std::string_view NameOf(DesignMethod method) {
  return method == DesignMethod::kMinimax ? "minimax" : "published";
}

std::string_view NameOf(TableTarget target) {
  switch (target) {
    case TableTarget::kHdrp:
      return "hdrp";
    case TableTarget::kPps:
      return "pps";
    case TableTarget::kResolve:
      return "resolve";
    case TableTarget::kPtb:
      return "ptb";
  }
  return "unknown";
}

absl::StatusOr<TableTarget> TableTargetOf(std::string_view name) {
  for (TableTarget target :
       {TableTarget::kHdrp, TableTarget::kPps, TableTarget::kResolve, TableTarget::kPtb}) {
    if (name == NameOf(target)) return target;
  }
  return BadInput("table target", "\"" + std::string(name) + "\" is none",
                  "give hdrp, pps, resolve or ptb");
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
  EYEBOX_RETURN_IF_ERROR(CheckSize(target, options.method, size));
  EYEBOX_RETURN_IF_ERROR(CheckWhite(target, options.white_u));
  EYEBOX_RETURN_IF_ERROR(CheckDesignedFor(target, options));
  TableDesign table;
  table.target = target;
  table.method = options.method;
  table.designed_for = options.designed_for;
  table.size = size;
  table.white_u = options.white_u;
  for (int i = 0; i < size; ++i) table.knots_u.push_back(UAtPosition(target, size, i));
  std::vector<double> entries = options.method == DesignMethod::kPublished
                                    ? Published(activation, table)
                                    : Designed(activation, table, options);
  // The strip holds k / 255, which float32 would only blur.
  table.entries = target == TableTarget::kPps ? entries : AsFloat32(std::move(entries));
  table.u_cutoff = CutoffOf(activation);
  table.certificate = Certify(table, activation, options);
  return table;
}

}  // namespace eyebox::fit
