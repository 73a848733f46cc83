#include "optics/photometry/spectral_mismatch.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"

namespace eyebox::optics {
namespace {

constexpr double kFromNm = 380;
constexpr double kToNm = 780;
constexpr double kTableStepNm = 5;
// Of the sums that stand for integrals: finer than any spectrum that is given.
constexpr double kStepNm = 0.5;

// CIE 1924 (ISO/CIE 23539), every 5 nm from 380 nm.
constexpr std::array<double, 81> kPhotopic = {
    0.000039,  0.000064,  0.00012,  0.000217,  0.000396, 0.00064,   0.00121, 0.00218,   0.004,
    0.0073,    0.0116,    0.01684,  0.023,     0.0298,   0.038,     0.048,   0.06,      0.0739,
    0.09098,   0.1126,    0.13902,  0.1693,    0.20802,  0.2586,    0.323,   0.4073,    0.503,
    0.6082,    0.71,      0.7932,   0.862,     0.91485,  0.954,     0.9803,  0.99495,   1,
    0.995,     0.9786,    0.952,    0.9154,    0.87,     0.8163,    0.757,   0.6949,    0.631,
    0.5668,    0.503,     0.4412,   0.381,     0.321,    0.265,     0.217,   0.175,     0.1382,
    0.107,     0.0816,    0.061,    0.04458,   0.032,    0.0232,    0.017,   0.01192,   0.00821,
    0.005723,  0.004102,  0.002929, 0.002091,  0.001484, 0.001047,  0.00074, 0.00052,   0.0003611,
    0.0002492, 0.0001719, 0.00012,  0.0000848, 0.00006,  0.0000424, 0.00003, 0.0000212, 0.000015};

// The integral of a spectrum times `weight` by the trapezoidal rule, each piece between entries in
// steps of its own, and its derivatives by the entries.
template <typename Weight>
double Integral(const Spectrum& spectrum, Weight weight, std::vector<double>* by_entry = nullptr) {
  if (by_entry != nullptr) by_entry->assign(spectrum.value.size(), 0);
  double sum = 0;
  for (size_t piece = 0; piece + 1 < spectrum.value.size(); ++piece) {
    const double from = spectrum.wavelength_nm[piece];
    const double length = spectrum.wavelength_nm[piece + 1] - from;
    const int steps = std::max(4, static_cast<int>(std::ceil(length / kStepNm)));
    double lower = 0;  // d(sum) / d(entry at the piece's lower end)
    double upper = 0;
    for (int i = 0; i <= steps; ++i) {
      const double share = static_cast<double>(i) / steps;
      const double w =
          weight(from + share * length) * length / steps * (i == 0 || i == steps ? 0.5 : 1);
      lower += w * (1 - share);
      upper += w * share;
    }
    sum += lower * spectrum.value[piece] + upper * spectrum.value[piece + 1];
    if (by_entry == nullptr) continue;
    (*by_entry)[piece] += lower;
    (*by_entry)[piece + 1] += upper;
  }
  return sum;
}

// Variance of ln(int a u / int a v) from the entries of `spectrum` a.
template <typename Upper, typename Lower>
double LogRatioVariance(const Spectrum& spectrum, Upper upper, Lower lower) {
  if (spectrum.sigma.empty()) return 0;
  std::vector<double> by_upper;
  std::vector<double> by_lower;
  const double u = Integral(spectrum, upper, &by_upper);
  const double v = Integral(spectrum, lower, &by_lower);
  double variance = 0;
  for (size_t i = 0; i < spectrum.value.size(); ++i) {
    variance += std::pow((by_upper[i] / u - by_lower[i] / v) * spectrum.sigma[i], 2);
  }
  return variance;
}

double Factor(const Spectrum& responsivity, const Spectrum& light, const Spectrum& calibration,
              double shift_nm) {
  const auto s = [&](double nm) { return responsivity.At(nm - shift_nm); };
  return Integral(light, PhotopicEfficiency) / Integral(light, s) * Integral(calibration, s) /
         Integral(calibration, PhotopicEfficiency);
}

}  // namespace

absl::Status Spectrum::Validate() const {
  if (wavelength_nm.size() < 2 || value.size() != wavelength_nm.size() ||
      (!sigma.empty() && sigma.size() != value.size())) {
    return BadInput("spectrum",
                    absl::StrCat(wavelength_nm.size(), " wavelengths, ", value.size(), " values"),
                    "give at least 2 of both");
  }
  for (size_t i = 0; i < value.size(); ++i) {
    const double s = sigma.empty() ? 0 : sigma[i];
    if (!std::isfinite(wavelength_nm[i] + value[i] + s) || value[i] < 0 || s < 0) {
      return BadInput(absl::StrCat("spectrum, entry ", i + 1), "is not finite, or below 0",
                      "give relative values of at least 0");
    }
    if (i > 0 && !(wavelength_nm[i] > wavelength_nm[i - 1])) {
      return BadInput(absl::StrCat("spectrum, entry ", i + 1), "wavelengths do not rise",
                      "sort them, one value each");
    }
  }
  if (*std::ranges::max_element(value) == 0) {
    return BadInput("spectrum", "is 0 everywhere", "give another");
  }
  return absl::OkStatus();
}

double Spectrum::At(double nm) const {
  if (!(nm >= wavelength_nm.front() && nm <= wavelength_nm.back())) return 0;
  const auto above = std::upper_bound(wavelength_nm.begin() + 1, wavelength_nm.end() - 1, nm);
  const auto i = static_cast<size_t>(above - wavelength_nm.begin());
  const double share = (nm - wavelength_nm[i - 1]) / (wavelength_nm[i] - wavelength_nm[i - 1]);
  return (1 - share) * value[i - 1] + share * value[i];
}

double PhotopicEfficiency(double wavelength_nm) {
  if (!(wavelength_nm >= kFromNm && wavelength_nm <= kToNm)) return 0;
  const double place = (wavelength_nm - kFromNm) / kTableStepNm;
  const size_t below = std::min(static_cast<size_t>(place), kPhotopic.size() - 2);
  const double share = place - static_cast<double>(below);
  return (1 - share) * kPhotopic[below] + share * kPhotopic[below + 1];
}

double IlluminantA(double wavelength_nm) {
  constexpr double kSecondRadiationNmK = 1.435e7;
  constexpr double kTemperatureK = 2848;
  constexpr double kReferenceNm = 560;
  return 100 * std::pow(kReferenceNm / wavelength_nm, 5) *
         std::expm1(kSecondRadiationNmK / (kTemperatureK * kReferenceNm)) /
         std::expm1(kSecondRadiationNmK / (kTemperatureK * wavelength_nm));
}

Spectrum IlluminantASpectrum() {
  Spectrum spectrum;
  for (double nm = kFromNm; nm <= kToNm; nm += kTableStepNm) {
    spectrum.wavelength_nm.push_back(nm);
    spectrum.value.push_back(IlluminantA(nm));
  }
  return spectrum;
}

absl::StatusOr<SpectralFactor> MismatchFactor(const Spectrum& responsivity, const Spectrum& light,
                                              const Spectrum& calibration_light,
                                              double wavelength_sigma_nm) {
  for (const Spectrum* spectrum : {&responsivity, &light, &calibration_light}) {
    EYEBOX_RETURN_IF_ERROR(spectrum->Validate());
  }
  const auto s = [&](double nm) { return responsivity.At(nm); };
  for (const Spectrum* spectrum : {&light, &calibration_light}) {
    if (Integral(*spectrum, s) > 0 && Integral(*spectrum, PhotopicEfficiency) > 0) continue;
    return Rejected("spectral mismatch", "the light is invisible to the detector or to the eye",
                    "give spectra from 380 to 780 nm");
  }
  SpectralFactor result;
  result.factor = Factor(responsivity, light, calibration_light, 0);
  const auto of_light = [&](double nm) { return light.At(nm); };
  const auto of_calibration = [&](double nm) { return calibration_light.At(nm); };
  const double variance = LogRatioVariance(light, PhotopicEfficiency, s) +
                          LogRatioVariance(calibration_light, s, PhotopicEfficiency) +
                          LogRatioVariance(responsivity, of_calibration, of_light);
  double by_shift = 0;
  if (wavelength_sigma_nm > 0) {
    by_shift = (Factor(responsivity, light, calibration_light, wavelength_sigma_nm) -
                Factor(responsivity, light, calibration_light, -wavelength_sigma_nm)) /
               2;
  }
  result.sigma = std::hypot(result.factor * std::sqrt(variance), by_shift);
  return result;
}

absl::StatusOr<double> F1Prime(const Spectrum& responsivity) {
  EYEBOX_RETURN_IF_ERROR(responsivity.Validate());
  const Spectrum a = IlluminantASpectrum();
  const auto s = [&](double nm) { return responsivity.At(nm); };
  const double seen = Integral(a, s);
  if (!(seen > 0)) {
    return Rejected("spectral mismatch", "the detector sees nothing from 380 to 780 nm",
                    "give its responsivity there");
  }
  const double scale = Integral(a, PhotopicEfficiency) / seen;
  double departure = 0;
  double whole = 0;
  const auto steps = static_cast<int>((kToNm - kFromNm) / kStepNm);
  for (int i = 0; i <= steps; ++i) {
    const double nm = kFromNm + i * kStepNm;
    departure += std::abs(scale * s(nm) - PhotopicEfficiency(nm));
    whole += PhotopicEfficiency(nm);
  }
  return departure / whole;
}

}  // namespace eyebox::optics
