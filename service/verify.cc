#include "service/verify.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "capture/base/status.h"
#include "capture/recording/reader.h"
#include "fit/activation/level_series.h"
#include "fit/color/colour_series.h"
#include "fit/cube/places.h"
#include "fit/cube/proportionality.h"
#include "optics/render/srgb.h"
#include "service/artifacts.h"
#include "service/results/parameter.h"
#include "service/results/standard.h"
#include "service/steps/calibrate.h"
#include "service/steps/levels.h"
#include "service/steps/within.h"

namespace eyebox::service {
namespace {

// What was asked for, as it is rendered, and the luminance of it.
struct Measured {
  std::vector<std::vector<double>> asked;
  std::vector<fit::RenderedReading> readings;
  std::string unit;
};

class Verification {
 public:
  Verification(const VerifyRequest& request, std::optional<Standard> standard, std::string input)
      : request_(request), standard_(std::move(standard)), is_srgb_(input == "srgb") {
    result_.set_input(std::move(input));
    result_.set_source(request.measured.filename().string());
    if (standard_) *result_.mutable_certificate() = standard_->certificate;
  }

  double Rendered(double m) const { return is_srgb_ ? optics::SrgbToLinear(m) : m; }

  void Add(Measured& measured, std::vector<double> asked, double luminance, double sigma) const {
    if (sigma == 0) sigma = request_.noise_relative * std::abs(luminance);
    std::vector<double> rendered;
    for (double m : asked) rendered.push_back(Rendered(m));
    measured.readings.push_back({std::move(rendered), luminance, sigma});
    measured.asked.push_back(std::move(asked));
  }

  absl::Status Describe(const Measured& measured) {
    result_.set_luminance_unit(measured.unit);
    EYEBOX_ASSIGN_OR_RETURN(
        const fit::LineThroughOrigin line,
        fit::FitLineThroughOrigin(measured.readings, request_.measured.string()));
    AddFigures(line);
    std::vector<fit::JudgedReading> judged;
    for (size_t i = 0; i < measured.readings.size(); ++i) {
      const fit::LineDeparture& departure = line.departures[i];
      v1::VerifyPoint& point = *result_.add_points();
      point.mutable_asked()->Add(measured.asked[i].begin(), measured.asked[i].end());
      point.set_luminance(measured.readings[i].luminance);
      point.set_luminance_sigma(measured.readings[i].luminance_sigma);
      point.set_line(departure.line);
      point.set_departure_of_value(departure.departure_of_value);
      point.set_departure_of_maximum(departure.departure_of_maximum);
      point.set_departure_of_maximum_sigma(departure.departure_of_maximum_sigma);
      if (const auto reading = Judged(measured.readings[i])) {
        point.set_judged(true);
        point.set_allowed(reading->allowed);
        judged.push_back(*reading);
      }
    }
    Judge(judged);
    return absl::OkStatus();
  }

  // Only grey within the certified range.
  std::optional<fit::JudgedReading> Judged(const fit::RenderedReading& reading) const {
    const std::vector<double>& u = reading.rendered;
    if (!standard_ || std::ranges::any_of(u, [&](double each) { return each != u.front(); })) {
      return std::nullopt;
    }
    const double x = u.front() / standard_->table.white_u;
    if (x < standard_->certificate.u_from() || x > 1) return std::nullopt;
    return fit::JudgedReading{x, reading.luminance, reading.luminance_sigma,
                              standard_->AllowedAt(x)};
  }

  v1::VerifyResult& result() { return result_; }
  const VerifyRequest& request() const { return request_; }

 private:
  void AddFigures(const fit::LineThroughOrigin& line) {
    auto& parameters = *result_.mutable_parameters();
    const std::string unit = result_.luminance_unit();
    if (line.slopes.size() == 1) {
      AddParameter(parameters, "slope", line.slopes[0], line.slope_sigmas[0], unit);
    } else {
      constexpr const char* kNames[] = {"slope_red", "slope_green", "slope_blue"};
      for (size_t k = 0; k < line.slopes.size(); ++k) {
        AddParameter(parameters, kNames[k], line.slopes[k], line.slope_sigmas[k], unit);
      }
    }
    AddParameter(parameters, "departure_of_maximum", line.worst_of_maximum,
                 line.worst_of_maximum_sigma, "1");
    AddParameter(parameters, "departure_of_value", line.worst_of_value, 0, "1");
    AddParameter(parameters, "rms_of_maximum", line.rms_of_maximum, 0, "1");
  }

  void Judge(const std::vector<fit::JudgedReading>& judged) {
    if (!standard_) {
      result_.set_verdict("not judged");
      result_.set_reason("no certificate was given");
      return;
    }
    if (judged.size() < 2) {
      result_.set_verdict("not judged");
      result_.set_reason("fewer than two grey readings lie in the range of the certificate");
      return;
    }
    const fit::Judgement judgement = fit::JudgeProportional(judged, judged.size());
    AddParameter(*result_.mutable_parameters(), "proportionality_error",
                 judgement.proportionality_error, 0, "1");
    result_.set_verdict(judgement.passes ? "pass" : "fail");
    const fit::JudgedReading& low = judged[judgement.lowest];
    const fit::JudgedReading& high = judged[judgement.highest];
    result_.set_reason(absl::StrFormat(
        "%d readings of u >= %.3g of white, each allowed the certificate's %.2f %%%s and %.2f "
        "sigma of noise: %s; the tightest pair is u = %.4f (too dark) and u = %.4f (too bright)",
        judged.size(), standard_->certificate.u_from(), 100 * standard_->certificate.max_relative(),
        standard_->has_output ? "" : ", half an 8-bit step", judgement.coverage_factor,
        judgement.passes ? "one line through the origin meets all" : "no line meets all", low.x,
        high.x));
    const auto unknown = [](const fit::JudgedReading& each) { return each.luminance_sigma == 0; };
    if (std::ranges::any_of(judged, unknown)) {
      result_.add_warnings(
          "readings without a sigma are taken as exact: give a column lum_sigma or --noise");
    }
  }

  const VerifyRequest& request_;
  std::optional<Standard> standard_;
  bool is_srgb_;
  v1::VerifyResult result_;
};

absl::Status VerifyGrey(Verification& verification) {
  EYEBOX_ASSIGN_OR_RETURN(const fit::LevelSeries series,
                          fit::ReadLevelSeriesCsv(verification.request().measured));
  Measured measured{{}, {}, series.luminance_unit};
  for (const fit::LevelReading& reading : series.readings) {
    verification.Add(measured, {reading.drive}, reading.luminance, reading.luminance_sigma);
  }
  return verification.Describe(measured);
}

// Luminance (Y) against the sum of what the channels give by themselves.
absl::Status VerifyColour(Verification& verification) {
  EYEBOX_ASSIGN_OR_RETURN(const fit::ColourSeries series,
                          fit::ReadColourSeriesCsv(verification.request().measured));
  Measured measured{{}, {}, "cd/m2"};
  for (const fit::ColourReading& reading : series.readings) {
    verification.Add(measured, {reading.drive[0], reading.drive[1], reading.drive[2]},
                     reading.colour[1], 0);
  }
  EYEBOX_RETURN_IF_ERROR(verification.Describe(measured));
  const auto white = series.MeanAt({1, 1, 1});
  const auto red = series.MeanAt({1, 0, 0});
  const auto green = series.MeanAt({0, 1, 0});
  const auto blue = series.MeanAt({0, 0, 1});
  if (white && red && green && blue) {
    v1::Parameter& parameter = *verification.result().mutable_white_against_primaries();
    parameter.set_name("white_against_primaries");
    parameter.set_value((*white)[1] / ((*red)[1] + (*green)[1] + (*blue)[1]) - 1);
    parameter.set_unit("1");
  }
  return absl::OkStatus();
}

struct PlaceMaps {
  Image<float> of_maximum, of_maximum_sigma, of_value, of_value_sigma, verdict;
};

// The worst departures of one place.
void DescribePlace(const Verification& verification, const Measured& measured, size_t family,
                   size_t index, PlaceMaps& maps, v1::VerifyResult& result) {
  const auto line = fit::FitLineThroughOrigin(measured.readings, "place");
  if (!line.ok()) return;
  std::vector<fit::JudgedReading> judged;
  for (size_t i = 0; i < measured.readings.size(); ++i) {
    const fit::LineDeparture& departure = line->departures[i];
    if (!(std::abs(maps.of_maximum.pixels()[index]) > std::abs(departure.departure_of_maximum))) {
      maps.of_maximum.pixels()[index] = static_cast<float>(departure.departure_of_maximum);
      maps.of_maximum_sigma.pixels()[index] =
          static_cast<float>(departure.departure_of_maximum_sigma);
    }
    const auto reading = verification.Judged(measured.readings[i]);
    if (!reading) continue;
    judged.push_back(*reading);
    if (!(std::abs(maps.of_value.pixels()[index]) > std::abs(departure.departure_of_value))) {
      maps.of_value.pixels()[index] = static_cast<float>(departure.departure_of_value);
      maps.of_value_sigma.pixels()[index] =
          static_cast<float>(reading->luminance_sigma / departure.line);
    }
  }
  result.set_places(result.places() + 1);
  if (judged.size() < 2) return;
  const bool passes = fit::JudgeProportional(judged, family).passes;
  maps.verdict.pixels()[index] = passes ? 1 : 0;
  if (!passes) result.set_places_failed(result.places_failed() + 1);
}

absl::Status DescribePlaces(const MeasuredLevels& levels, Verification& verification) {
  const fit::PlaceGrid grid{levels.size, verification.request().place_px};
  const ImageSize size = grid.size();
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  PlaceMaps maps{Image<float>(size, kNone), Image<float>(size, kNone), Image<float>(size, kNone),
                 Image<float>(size, kNone), Image<float>(size, kNone)};
  v1::VerifyResult& result = verification.result();
  const size_t count = size.PixelCount();
  for (size_t index = 0; index < count; ++index) {
    const fit::PlaceSeries series =
        fit::AverageOverPlace(grid, index, levels.drives.size(), levels.luminance, levels.valid);
    if (series.mean.empty()) continue;
    Measured measured;
    for (size_t level = 0; level < series.mean.size(); ++level) {
      verification.Add(measured, {levels.drives[level]}, series.mean[level], series.sigma[level]);
    }
    DescribePlace(verification, measured, count * series.mean.size(), index, maps, result);
  }
  result.set_place_px(grid.side_px);
  struct Map {
    const char* name;
    const Image<float>& values;
  };
  for (const Map& map :
       {Map{"departure_of_maximum", maps.of_maximum},
        Map{"departure_of_maximum_sigma", maps.of_maximum_sigma},
        Map{"departure_of_value", maps.of_value},
        Map{"departure_of_value_sigma", maps.of_value_sigma}, Map{"verdict", maps.verdict}}) {
    EYEBOX_ASSIGN_OR_RETURN(*result.add_maps(), WriteMap(verification.request().folder,
                                                         absl::StrCat("verify_", map.name, ".npy"),
                                                         map.name, "1", map.values));
  }
  return absl::OkStatus();
}

absl::Status VerifyRecording(Verification& verification, const Watcher& watcher) {
  const VerifyRequest& request = verification.request();
  EYEBOX_ASSIGN_OR_RETURN(const auto reader, capture::RecordingReader::Open(request.measured));
  EYEBOX_ASSIGN_OR_RETURN(const std::string series, ChooseSeries(*reader, request.series));
  EYEBOX_ASSIGN_OR_RETURN(const optics::Calibration calibration,
                          CalibrateCamera(*reader, watcher.Part(0, 0.4)));
  EYEBOX_ASSIGN_OR_RETURN(const MeasuredLevels levels,
                          ReduceGreyLevels(*reader, series, calibration, watcher.Part(0.4, 0.9)));
  Measured measured{{}, {}, levels.series.luminance_unit};
  for (const fit::LevelReading& reading : levels.series.readings) {
    verification.Add(measured, {reading.drive}, reading.luminance, reading.luminance_sigma);
  }
  EYEBOX_RETURN_IF_ERROR(verification.Describe(measured));
  verification.result().mutable_warnings()->Add(levels.warnings.begin(), levels.warnings.end());
  EYEBOX_RETURN_IF_ERROR(watcher.Reach(0.9, "places of the field"));
  EYEBOX_RETURN_IF_ERROR(DescribePlaces(levels, verification));
  if (watcher.progress) watcher.progress({1, "done"});
  return absl::OkStatus();
}

absl::Status CheckRequest(const VerifyRequest& request) {
  if (!request.input.empty() && request.input != "srgb" && request.input != "linear") {
    return BadInput("input", "\"" + request.input + "\" is none", "give srgb or linear");
  }
  if (!(request.noise_relative >= 0 && request.noise_relative < 1)) {
    return BadInput("noise", absl::StrCat(request.noise_relative, " is no share"),
                    "give the relative standard uncertainty of a reading, such as 0.005");
  }
  if (request.place_px >= 1) return absl::OkStatus();
  return BadInput("place", absl::StrCat(request.place_px, " is no size"), "give 1 pixel or more");
}

}  // namespace

absl::StatusOr<v1::VerifyResult> Verify(const VerifyRequest& request, const Watcher& watcher) {
  EYEBOX_RETURN_IF_ERROR(CheckRequest(request));
  std::optional<Standard> standard;
  std::string input = request.input;
  if (!request.certificate.empty()) {
    EYEBOX_ASSIGN_OR_RETURN(standard, ReadStandard(request.certificate));
    const bool is_hdrp = standard->table.target == fit::TableTarget::kHdrp;
    if (input.empty()) input = is_hdrp ? "srgb" : "linear";
  }
  if (input.empty()) input = "srgb";
  Verification verification(request, std::move(standard), std::move(input));
  if (std::filesystem::is_directory(request.measured)) {
    const absl::Status status = VerifyRecording(verification, watcher);
    if (!status.ok()) return Within(request.measured, status);
    return std::move(verification.result());
  }
  EYEBOX_ASSIGN_OR_RETURN(const bool holds_colours, fit::HoldsColours(request.measured));
  EYEBOX_RETURN_IF_ERROR(holds_colours ? VerifyColour(verification) : VerifyGrey(verification));
  return std::move(verification.result());
}

}  // namespace eyebox::service
