#include "service/probe.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "capture/base/csv.h"
#include "capture/base/file.h"
#include "capture/base/status.h"
#include "fit/cube/probe.h"
#include "fit/cube/table_file.h"
#include "optics/render/srgb.h"
#include "service/results/activation.h"
#include "service/results/cube.h"
#include "service/results/parameter.h"

namespace eyebox::service {
namespace {

constexpr int kFewestPatches = 4;
constexpr int kMostPatches = 40;
// Below this many squared sigmas two hypotheses cannot be expected to part with certainty.
constexpr double kToldApartFrom = 30;

absl::Status CheckRequest(const ProbeRequest& request) {
  if (request.patches < kFewestPatches || request.patches > kMostPatches) {
    return BadInput("patches", absl::StrCat(request.patches, " is no number of patches"),
                    absl::StrCat("give ", kFewestPatches, " to ", kMostPatches));
  }
  if (request.noise_relative > 0 && request.noise_relative < 1) return absl::OkStatus();
  return BadInput("noise", absl::StrCat(request.noise_relative, " is no share"),
                  "give the relative standard uncertainty of a reading, such as 0.005");
}

// HDRP shows an unlit material m as u = s(m); elsewhere what is drawn is what is looked up.
double MaterialFor(fit::TableTarget target, double u) {
  return target == fit::TableTarget::kHdrp ? optics::LinearToSrgb(u) : u;
}
double RenderedFrom(fit::TableTarget target, double m) {
  return target == fit::TableTarget::kHdrp ? optics::SrgbToLinear(m) : m;
}

absl::StatusOr<fit::Cube3d> TableOf(const ProbeRequest& request, const fit::Activation& activation,
                                    v1::ProbeResult& result) {
  if (!request.table.empty()) {
    return request.cube.target == fit::TableTarget::kPps ? fit::ReadStrip(request.table)
                                                         : fit::ReadCube(request.table);
  }
  EYEBOX_ASSIGN_OR_RETURN(
      const fit::TableDesign table,
      fit::DesignTable(activation, request.cube.target, request.cube.size, request.cube.design));
  EYEBOX_ASSIGN_OR_RETURN(const std::string bytes, fit::EncodeTable(table));
  const std::string name =
      request.cube.target == fit::TableTarget::kPps ? "probe.png" : "probe.cube";
  *result.mutable_table() = DescribeCube(table, request.cube.fit, name, bytes);
  if (!request.out.empty()) {
    EYEBOX_RETURN_IF_ERROR(WriteFileAtomically(request.out / name, bytes));
    result.add_files(name);
  }
  return fit::ToCube(table, "");
}

absl::StatusOr<std::vector<fit::ProbeReading>> ReadReadings(const ProbeRequest& request) {
  EYEBOX_ASSIGN_OR_RETURN(const CsvTable table, ReadCsv(request.readings));
  const std::optional<size_t> u_column = table.FindColumn("u");
  size_t input = 0;
  if (u_column) {
    input = *u_column;
  } else {
    EYEBOX_ASSIGN_OR_RETURN(input, table.Column("m_k"));
  }
  EYEBOX_ASSIGN_OR_RETURN(const size_t luminance, table.Column("lum"));
  const std::optional<size_t> sigma = table.FindColumn("lum_sigma");
  std::vector<fit::ProbeReading> readings;
  for (size_t row = 0; row < table.RowCount(); ++row) {
    fit::ProbeReading reading;
    EYEBOX_ASSIGN_OR_RETURN(reading.u, table.Number(row, input));
    if (!u_column) reading.u = RenderedFrom(request.cube.target, reading.u);
    EYEBOX_ASSIGN_OR_RETURN(reading.luminance, table.Number(row, luminance));
    if (sigma) {
      EYEBOX_ASSIGN_OR_RETURN(reading.sigma, table.Number(row, *sigma));
    }
    if (!(reading.u > 0) || !(reading.luminance > 0) || reading.sigma < 0) {
      return BadInput(table.Where(row, luminance),
                      "the stimulus and its luminance must be above 0, its sigma not below",
                      "read the patch again or leave it out");
    }
    if (reading.sigma == 0) reading.sigma = request.noise_relative * reading.luminance;
    readings.push_back(reading);
  }
  return readings;
}

void DescribePatches(const std::vector<double>& patches, fit::TableTarget target,
                     const std::vector<fit::ProbeHypothesis>& hypotheses,
                     const fit::Activation& activation, v1::ProbeResult& result) {
  constexpr double kUsualExponent = 1.1;
  for (double u : patches) {
    v1::ProbePatch& patch = *result.add_patches();
    patch.set_u(u);
    patch.set_m_k(MaterialFor(target, u));
    for (const fit::ProbeHypothesis& hypothesis : hypotheses) {
      patch.add_expected(
          hypothesis.Luminance(activation, u, hypothesis.has_exponent() ? kUsualExponent : 1));
    }
  }
}

std::string PatchesAsCsv(const v1::ProbeResult& result) {
  std::string text = "u,m_k";
  for (const v1::ProbeHypothesis& hypothesis : result.hypotheses()) {
    absl::StrAppend(&text, ",", hypothesis.name());
  }
  text += "\n";
  for (const v1::ProbePatch& patch : result.patches()) {
    absl::StrAppendFormat(&text, "%.6f,%.6f", patch.u(), patch.m_k());
    for (double expected : patch.expected()) absl::StrAppendFormat(&text, ",%.4f", expected);
    text += "\n";
  }
  return text;
}

void Plan(const ProbeRequest& request, const std::vector<fit::ProbeHypothesis>& hypotheses,
          const fit::Activation& activation, v1::ProbeResult& result) {
  const std::vector<double> patches =
      fit::ChooseProbePatches(hypotheses, activation, request.patches, request.noise_relative);
  DescribePatches(patches, request.cube.target, hypotheses, activation, result);
  for (const fit::ProbeHypothesis& hypothesis : hypotheses) {
    result.add_hypotheses()->set_name(hypothesis.name());
  }
  for (size_t i = 0; i < hypotheses.size(); ++i) {
    for (size_t k = 0; k < i; ++k) {
      const double separation = fit::ProbeSeparation(hypotheses[i], hypotheses[k], activation,
                                                     patches, request.noise_relative);
      if (separation >= kToldApartFrom) continue;
      result.add_indistinguishable(absl::StrFormat("%s / %s (%.1f sigma)", hypotheses[k].name(),
                                                   hypotheses[i].name(), std::sqrt(separation)));
    }
  }
}

absl::Status Judge(const ProbeRequest& request, const std::vector<fit::ProbeHypothesis>& hypotheses,
                   const fit::Activation& activation, v1::ProbeResult& result) {
  EYEBOX_ASSIGN_OR_RETURN(const std::vector<fit::ProbeReading> readings, ReadReadings(request));
  EYEBOX_ASSIGN_OR_RETURN(const fit::ProbeVerdict verdict,
                          fit::JudgeProbe(hypotheses, activation, readings));
  std::vector<double> patches;
  for (const fit::ProbeReading& reading : readings) patches.push_back(reading.u);
  DescribePatches(patches, request.cube.target, hypotheses, activation, result);
  for (size_t i = 0; i < readings.size(); ++i) {
    result.mutable_patches(static_cast<int>(i))->set_reading(readings[i].luminance);
  }
  size_t likeliest = 0;
  for (size_t i = 0; i < hypotheses.size(); ++i) {
    const fit::ProbeLikelihood& likelihood = verdict.likelihoods[i];
    v1::ProbeHypothesis& message = *result.add_hypotheses();
    message.set_name(hypotheses[i].name());
    message.set_chi_square(likelihood.chi_square);
    message.set_free_parameters(likelihood.free_parameters);
    message.set_log_likelihood_ratio(likelihood.log_likelihood_ratio);
    message.set_probability(likelihood.probability);
    if (hypotheses[i].has_exponent()) message.set_exponent(likelihood.exponent);
    if (likelihood.probability > verdict.likelihoods[likeliest].probability) likeliest = i;
  }
  AddParameter(*result.mutable_parameters(), "scale", verdict.likelihoods[likeliest].scale, 0, "1");
  result.set_verdict(verdict.verdict);
  result.set_reason(verdict.reason);
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<v1::ProbeResult> Probe(const ProbeRequest& request) {
  EYEBOX_RETURN_IF_ERROR(CheckRequest(request));
  EYEBOX_ASSIGN_OR_RETURN(const fit::Activation activation,
                          ActivationOf(request.cube.fit, request.cube.fit_source));
  v1::ProbeResult result;
  AddParameter(*result.mutable_parameters(), "noise_relative", request.noise_relative, 0, "1");
  EYEBOX_ASSIGN_OR_RETURN(const fit::Cube3d table, TableOf(request, activation, result));
  EYEBOX_ASSIGN_OR_RETURN(const std::vector<fit::ProbeHypothesis> hypotheses,
                          fit::ProbeHypotheses(request.cube.target, table));
  if (!request.readings.empty()) {
    EYEBOX_RETURN_IF_ERROR(Judge(request, hypotheses, activation, result));
    return result;
  }
  Plan(request, hypotheses, activation, result);
  if (!request.out.empty()) {
    EYEBOX_RETURN_IF_ERROR(WriteFileAtomically(request.out / "probe.csv", PatchesAsCsv(result)));
    result.add_files("probe.csv");
  }
  return result;
}

}  // namespace eyebox::service
