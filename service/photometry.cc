#include "service/photometry.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "capture/base/csv.h"
#include "capture/base/status.h"
#include "fit/base/conditioning.h"
#include "optics/photometry/colour_matrix.h"
#include "optics/photometry/fit_luminance_scale.h"
#include "optics/photometry/photodiode_scale.h"
#include "optics/photometry/spectral_mismatch.h"
#include "service/results/parameter.h"

namespace eyebox::service {
namespace {

constexpr char kSigma[] = "_sigma";

// A fit's message names what it is about; the file stands before it.
absl::Status In(const CsvTable& table, const absl::Status& status) {
  return {status.code(), absl::StrCat(table.File().string(), ": ", status.message())};
}

absl::StatusOr<std::vector<double>> Numbers(const CsvTable& table, std::string_view name) {
  EYEBOX_ASSIGN_OR_RETURN(const size_t column, table.Column(name));
  std::vector<double> numbers;
  for (size_t row = 0; row < table.RowCount(); ++row) {
    EYEBOX_ASSIGN_OR_RETURN(const double number, table.Number(row, column));
    numbers.push_back(number);
  }
  return numbers;
}

// Empty where there is no such column.
absl::StatusOr<std::vector<double>> NumbersIfAny(const CsvTable& table, std::string_view name) {
  if (!table.FindColumn(name)) return std::vector<double>();
  return Numbers(table, name);
}

absl::StatusOr<std::vector<optics::ScaleReading>> Readings(const CsvTable& table,
                                                           std::string_view reading,
                                                           std::string_view reading_sigma) {
  EYEBOX_ASSIGN_OR_RETURN(const auto luminance, Numbers(table, "luminance_cd_m2"));
  EYEBOX_ASSIGN_OR_RETURN(const auto sigma, NumbersIfAny(table, "luminance_sigma_cd_m2"));
  EYEBOX_ASSIGN_OR_RETURN(const auto value, Numbers(table, reading));
  EYEBOX_ASSIGN_OR_RETURN(const auto value_sigma, NumbersIfAny(table, reading_sigma));
  std::vector<optics::ScaleReading> readings;
  for (size_t i = 0; i < value.size(); ++i) {
    readings.push_back({.luminance_cd_m2 = luminance[i],
                        .luminance_sigma = sigma.empty() ? 0 : sigma[i],
                        .reading = value[i],
                        .reading_sigma = value_sigma.empty() ? 0 : value_sigma[i]});
  }
  return readings;
}

void AddPoint(double luminance, double reading, double fitted, double residual,
              v1::ScalePoint& point) {
  point.set_luminance_cd_m2(luminance);
  point.set_reading(reading);
  point.set_fitted_cd_m2(fitted);
  point.set_relative_residual(residual);
}

absl::StatusOr<optics::Spectrum> SpectrumOf(const CsvTable& table, const std::string& name) {
  optics::Spectrum spectrum;
  EYEBOX_ASSIGN_OR_RETURN(spectrum.wavelength_nm, Numbers(table, "wavelength_nm"));
  EYEBOX_ASSIGN_OR_RETURN(spectrum.value, Numbers(table, name));
  EYEBOX_ASSIGN_OR_RETURN(spectrum.sigma, NumbersIfAny(table, name + kSigma));
  return spectrum;
}

absl::StatusOr<std::vector<optics::ColourSample>> Samples(const CsvTable& table) {
  constexpr const char* kSignals[] = {"signal_r", "signal_g", "signal_b"};
  constexpr const char* kValues[] = {"x", "y", "z"};
  std::vector<optics::ColourSample> samples(table.RowCount());
  for (size_t k = 0; k < 3; ++k) {
    EYEBOX_ASSIGN_OR_RETURN(const auto signal, Numbers(table, kSignals[k]));
    EYEBOX_ASSIGN_OR_RETURN(const auto value, Numbers(table, kValues[k]));
    EYEBOX_ASSIGN_OR_RETURN(const auto sigma,
                            NumbersIfAny(table, std::string(kValues[k]) + kSigma));
    for (size_t i = 0; i < samples.size(); ++i) {
      samples[i].signal[k] = signal[i];
      samples[i].xyz[k] = value[i];
      samples[i].xyz_sigma[k] = sigma.empty() ? 0 : sigma[i];
    }
  }
  return samples;
}

double WorstCondition(const optics::ColourMatrix& matrix) {
  const std::span<const double> rows = matrix.covariance;
  const auto block = static_cast<size_t>(matrix.columns) * matrix.columns;
  double worst = 1;
  for (size_t row = 0; row < 3; ++row) {
    worst = std::max(worst, fit::ConditionNumber(rows.subspan(row * block, block)));
  }
  return worst;
}

void DescribeMatrix(const optics::ColourMatrix& matrix, bool absolute,
                    v1::PhotometryResult& result) {
  v1::ColourScale& colour = *result.mutable_colour();
  colour.set_columns(matrix.columns);
  colour.set_unit(absolute ? "cd/m2" : "relative");
  colour.set_leave_one_out_rms_3(matrix.leave_one_out_rms_3);
  colour.set_leave_one_out_rms_4(matrix.leave_one_out_rms_4);
  colour.mutable_matrix()->Add(matrix.matrix.begin(), matrix.matrix.end());
  colour.mutable_covariance()->Add(matrix.covariance.begin(), matrix.covariance.end());
  colour.set_condition_number(WorstCondition(matrix));
  const std::string unit = absolute ? "cd/m2 per DN/s" : "relative";
  for (int row = 0; row < 3; ++row) {
    for (int k = 0; k < matrix.columns; ++k) {
      const size_t at = static_cast<size_t>(row) * matrix.columns + k;
      const double variance = matrix.covariance[at * matrix.columns + k];
      AddParameter(*colour.mutable_parameters(), std::string("m_") + "xyz"[row] + "rgb1"[k],
                   matrix.matrix[at], std::sqrt(variance), k < 3 ? unit : colour.unit());
    }
  }
  *result.mutable_parameters() = colour.parameters();
}

}  // namespace

absl::StatusOr<v1::PhotometryResult> ScaleOfCamera(const std::filesystem::path& csv,
                                                   const PhotometryOptions& options) {
  EYEBOX_ASSIGN_OR_RETURN(const CsvTable table, ReadCsv(csv));
  EYEBOX_ASSIGN_OR_RETURN(const auto readings,
                          Readings(table, "reading_dn_s", "reading_sigma_dn_s"));
  const auto fit =
      optics::FitLuminanceScale(readings, {.meter_relative_sigma = options.meter_relative_sigma});
  if (!fit.ok()) return In(table, fit.status());
  v1::PhotometryResult result;
  v1::LuminanceScale& scale = *result.mutable_luminance();
  auto& parameters = *scale.mutable_parameters();
  const double slope = fit->per_unit.luminance_cd_m2;
  AddParameter(parameters, "cd_m2_per_dn_per_s", slope, slope * fit->per_unit.relative_sigma,
               "cd/m2 per DN/s");
  AddParameter(parameters, "intercept_cd_m2", fit->intercept_cd_m2, fit->intercept_sigma_cd_m2,
               "cd/m2");
  AddParameter(parameters, "slope_with_intercept", fit->slope_with_intercept,
               fit->slope_with_intercept_sigma, "cd/m2 per DN/s");
  *result.mutable_parameters() = parameters;
  scale.set_intercept_p_value(fit->intercept_p_value);
  scale.set_reduced_chi_square(fit->reduced_chi2);
  scale.set_chi_square_p_value(fit->chi2_p_value);
  scale.set_relative_sigma(fit->per_unit.relative_sigma);
  scale.set_meter_relative_sigma(options.meter_relative_sigma);
  for (size_t i = 0; i < readings.size(); ++i) {
    const double known = readings[i].luminance_cd_m2;
    const double fitted = fit->fitted_cd_m2[i];
    AddPoint(known, readings[i].reading, fitted, known > 0 ? fitted / known - 1 : std::nan(""),
             *scale.add_points());
  }
  result.set_source(csv.filename().string());
  result.set_accepted(fit->accepted);
  AddAll(*result.mutable_reasons(), fit->reasons);
  AddAll(*result.mutable_warnings(), fit->warnings);
  return result;
}

absl::StatusOr<v1::PhotometryResult> ScaleOfPhotodiode(const std::filesystem::path& csv,
                                                       const PhotometryOptions& options) {
  EYEBOX_ASSIGN_OR_RETURN(const CsvTable table, ReadCsv(csv));
  EYEBOX_ASSIGN_OR_RETURN(const auto readings, Readings(table, "counts", "counts_sigma"));
  const auto fit = optics::FitPhotodiode(readings, options.meter_relative_sigma);
  if (!fit.ok()) return In(table, fit.status());
  v1::PhotometryResult result;
  v1::PhotodiodeScale& scale = *result.mutable_photodiode();
  AddParameter(*scale.mutable_parameters(), "leave_one_out_rms_relative",
               fit->leave_one_out_rms_relative, 0, "1");
  *result.mutable_parameters() = scale.parameters();
  scale.set_axes(optics::NameOf(fit->scale.Axes()));
  scale.set_relative_sigma(fit->relative_sigma);
  const auto counts = fit->scale.Counts();
  const auto luminance = fit->scale.LuminanceCdM2();
  for (size_t i = 0; i < counts.size(); ++i) {
    scale.add_counts(counts[i]);
    scale.add_luminance_cd_m2(luminance[i]);
    const double residual = fit->leave_one_out_relative[i];
    AddPoint(luminance[i], counts[i], luminance[i], residual, *scale.add_points());
  }
  result.set_source(csv.filename().string());
  result.set_accepted(true);
  AddAll(*result.mutable_warnings(), fit->warnings);
  return result;
}

absl::StatusOr<v1::PhotometryResult> SpectralMismatchOf(const std::filesystem::path& csv,
                                                        const PhotometryOptions& options) {
  EYEBOX_ASSIGN_OR_RETURN(const CsvTable table, ReadCsv(csv));
  EYEBOX_ASSIGN_OR_RETURN(const optics::Spectrum detector, SpectrumOf(table, "responsivity"));
  optics::Spectrum calibration = optics::IlluminantASpectrum();
  if (!options.calibration_light.empty()) {
    EYEBOX_ASSIGN_OR_RETURN(calibration, SpectrumOf(table, options.calibration_light));
  }
  const auto f1_prime = optics::F1Prime(detector);
  if (!f1_prime.ok()) return In(table, f1_prime.status());
  v1::PhotometryResult result;
  v1::SpectralMismatch& mismatch = *result.mutable_mismatch();
  AddParameter(*mismatch.mutable_parameters(), "f1_prime", *f1_prime, 0, "1");
  mismatch.set_calibration_light(options.calibration_light.empty() ? "CIE illuminant A"
                                                                   : options.calibration_light);
  for (const std::string_view header : table.Header()) {
    const std::string name(header);
    if (name == "wavelength_nm" || name == "responsivity" || absl::EndsWith(name, kSigma)) continue;
    EYEBOX_ASSIGN_OR_RETURN(const optics::Spectrum light, SpectrumOf(table, name));
    const auto factor =
        optics::MismatchFactor(detector, light, calibration, options.wavelength_sigma_nm);
    if (!factor.ok()) return In(table, factor.status());
    v1::SpectralCorrection& correction = *mismatch.add_corrections();
    correction.set_light(name);
    correction.set_factor(factor->factor);
    correction.set_sigma(factor->sigma);
    AddParameter(*result.mutable_parameters(), absl::StrCat("mismatch_", name), factor->factor,
                 factor->sigma, "1");
  }
  if (mismatch.corrections().empty()) {
    return BadInput(csv.string(), "holds no light", "add a column with its spectrum");
  }
  result.set_source(csv.filename().string());
  result.set_accepted(true);
  return result;
}

absl::StatusOr<v1::PhotometryResult> ScaleOfColour(const std::filesystem::path& csv,
                                                   const PhotometryOptions& options) {
  EYEBOX_ASSIGN_OR_RETURN(const CsvTable table, ReadCsv(csv));
  EYEBOX_ASSIGN_OR_RETURN(const auto samples, Samples(table));
  const auto matrix = optics::FitColourMatrix(samples);
  if (!matrix.ok()) return In(table, matrix.status());
  v1::PhotometryResult result;
  DescribeMatrix(*matrix, options.absolute, result);
  result.set_source(csv.filename().string());
  result.set_accepted(true);
  if (!options.absolute) {
    result.add_warnings("relative: say --absolute if the tristimulus values are in cd/m2");
  }
  return result;
}

}  // namespace eyebox::service
