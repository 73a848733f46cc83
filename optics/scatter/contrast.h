// Contrast and glare figures of a display, each with what the instrument itself would make of a
// display without any flaw.
#ifndef EYEBOX_OPTICS_SCATTER_CONTRAST_H_
#define EYEBOX_OPTICS_SCATTER_CONTRAST_H_

#include <optional>

#include "absl/status/statusor.h"
#include "optics/photometry/luminance_image.h"
#include "optics/scatter/scatter_kernel.h"
#include "optics/uniformity/uniformity_map.h"

namespace eyebox::optics {

// The instrument's scatter where it was not corrected; grid of equal steps in field angle.
struct InstrumentGlare {
  ScatterKernel kernel;
  double pitch_deg = 0;
};

// Noise counts with 3 sigma in every limit. Sigmas are of noise alone: the luminance scale cancels.
struct ContrastFigure {
  double contrast = 0;  // bright / dark; `limit` where that is not reached
  double sigma = 0;
  // Largest contrast that the instrument could have shown: its glare and its noise make up
  // 1 / limit of the bright luminance.
  double limit = 0;
  bool only_lower_bound = false;  // dark is within its noise of 0: the truth is at least `contrast`
  double bright = 0;              // means, unit of the image
  double dark = 0;
};

struct GlareFigure {
  double share = 0;  // luminance in the black spot / luminance of the bright field
  double sigma = 0;
  double instrument_share = 0;  // that a flawless display would show: the instrument's own glare
  double floor = 0;             // instrument_share + 3 sigma of noise
};

// A disk in which to average.
struct MeasuringDisk {
  PixelPoint centre;
  double radius_px = 1;
};

// White and black full fields, one after the other: scatter scales both and sets no limit.
// Errors: those of MeanOverDisk; FailedPrecondition (white not above its noise).
absl::StatusOr<ContrastFigure> FullFieldContrast(const LuminanceImage& white,
                                                 const LuminanceImage& black,
                                                 const MeasuringDisk& disk);

struct Checkerboard {
  PixelPoint corner;  // outer corner, upper left: -0.5 is the edge of the first pixel
  double square_px = 0;
  int columns = 0;
  int rows = 0;
  bool first_is_bright = true;
  double measured_fraction = 0.5;  // diameter of the disk in each square, of its side
  // The display goes on with squares beyond these, as far as its light scatters.
  bool continued = false;
};

// As many whole squares as the image shows on each side of the axis, on which four of them meet;
// the one above it to the left is bright. Continued. Errors: InvalidArgument (side not above 0),
// FailedPrecondition (a square does not fit on each side of the axis).
absl::StatusOr<Checkerboard> CheckerboardAround(ImageSize size, const PixelPoint& axis,
                                                double square_px);

// Mean of the bright squares over mean of the dark ones. `instrument`: unless corrected.
// Errors: InvalidArgument (fewer than 2 squares, a board that does not lie in the image, kernel),
// FailedPrecondition (a square without a valid pixel, bright not above its noise).
absl::StatusOr<ContrastFigure> CheckerboardContrast(
    const LuminanceImage& image, const Checkerboard& board,
    const std::optional<InstrumentGlare>& instrument);

// The board as it should be, 1 and 0 (also around it), pixels by the share that is bright.
Image<float> DrawCheckerboard(ImageSize size, const Checkerboard& board);

struct BlackSpot {
  MeasuringDisk disk;  // well within the spot
  double spot_diameter_deg = 0;
  double field_radius_deg = 50;
};

// A black spot on a bright field over the same place of the bright field alone.
// Errors: those of MeanOverDisk; InvalidArgument (kernel, diameter), FailedPrecondition (field not
// above its noise).
absl::StatusOr<GlareFigure> BlackSpotGlare(const LuminanceImage& with_spot,
                                           const LuminanceImage& field, const BlackSpot& spot,
                                           const std::optional<ScatterKernel>& instrument);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_SCATTER_CONTRAST_H_
