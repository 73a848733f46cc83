// Scales from tables of known lights: what counts mean in cd/m2 and in colour.
#ifndef EYEBOX_SERVICE_PHOTOMETRY_H_
#define EYEBOX_SERVICE_PHOTOMETRY_H_

#include <filesystem>
#include <string>

#include "absl/status/statusor.h"
#include "eyebox/v1/photometry.pb.h"

namespace eyebox::service {

struct PhotometryOptions {
  double meter_relative_sigma = 0;  // of the calibration of the meter; scale and photodiode
  std::string calibration_light;    // column, of mismatch; empty: CIE illuminant A
  double wavelength_sigma_nm = 0;   // common shift of the responsivity, of mismatch
  bool absolute = false;            // tristimulus values are in cd/m2, of colour
};

// Each reads a CSV and names file, line and column of what is wrong. Errors also: those of the fit.
// Columns luminance_cd_m2, reading_dn_s, and at least one of luminance_sigma_cd_m2 and
// reading_sigma_dn_s.
absl::StatusOr<v1::PhotometryResult> ScaleOfCamera(const std::filesystem::path& csv,
                                                   const PhotometryOptions& options);
// Columns luminance_cd_m2, counts[, counts_sigma].
absl::StatusOr<v1::PhotometryResult> ScaleOfPhotodiode(const std::filesystem::path& csv,
                                                       const PhotometryOptions& options);
// Columns wavelength_nm, responsivity, and one a light, each with NAME_sigma if it is known.
absl::StatusOr<v1::PhotometryResult> SpectralMismatchOf(const std::filesystem::path& csv,
                                                        const PhotometryOptions& options);
// Columns signal_r, signal_g, signal_b, x, y, z[, x_sigma, y_sigma, z_sigma].
absl::StatusOr<v1::PhotometryResult> ScaleOfColour(const std::filesystem::path& csv,
                                                   const PhotometryOptions& options);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_PHOTOMETRY_H_
