// What a detector misreads on light of another spectrum than it was calibrated with
// (ISO/CIE 19476:2014, formerly CIE S 023 and CIE 69).
#ifndef EYEBOX_OPTICS_PHOTOMETRY_SPECTRAL_MISMATCH_H_
#define EYEBOX_OPTICS_PHOTOMETRY_SPECTRAL_MISMATCH_H_

#include <span>
#include <vector>

#include "absl/status/statusor.h"

namespace eyebox::optics {

// A relative quantity at rising wavelengths, linear in between and 0 beyond the ends.
struct Spectrum {
  std::vector<double> wavelength_nm;
  std::vector<double> value;
  std::vector<double> sigma;  // independent from one wavelength to the next; empty: exact

  // Errors: InvalidArgument (fewer than 2 wavelengths, other lengths, not rising, not finite, a
  // value or sigma below 0, all of them 0).
  absl::Status Validate() const;
  double At(double wavelength_nm) const;
};

// V(lambda) of the CIE 1924 observer, 380 to 780 nm, linear between its entries 5 nm apart.
double PhotopicEfficiency(double wavelength_nm);
// CIE standard illuminant A (ISO 11664-2), 100 at 560 nm.
double IlluminantA(double wavelength_nm);
// The same from 380 to 780 nm, for calibrations at a standard lamp.
Spectrum IlluminantASpectrum();

struct SpectralFactor {
  double factor = 1;  // the reading times this is the luminance
  double sigma = 0;   // standard uncertainty
};

// F* = (int S_Z V / int S_Z s) (int S_C s / int S_C V): S_Z the light that is measured, S_C the one
// that the detector was calibrated with, s the detector's responsivity. The sigmas of all three
// spectra enter, and `wavelength_sigma_nm` of a shift that is common to s.
// Errors: those of Spectrum::Validate(); FailedPrecondition (detector and light have nothing in
// common, or the light has none that the eye sees).
absl::StatusOr<SpectralFactor> MismatchFactor(const Spectrum& responsivity, const Spectrum& light,
                                              const Spectrum& calibration_light,
                                              double wavelength_sigma_nm = 0);

// f1' = int |s* - V| / int V, s* the responsivity scaled to V under illuminant A. 0 is a perfect
// match; good photometers have 0.015, filtered cameras 0.1 and more.
// Errors: as above.
absl::StatusOr<double> F1Prime(const Spectrum& responsivity);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_PHOTOMETRY_SPECTRAL_MISMATCH_H_
