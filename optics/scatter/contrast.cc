#include "optics/scatter/contrast.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"
#include "optics/scatter/spot_photometer.h"
#include "optics/scatter/spread_light.h"
#include "optics/uniformity/point_uniformity.h"

namespace eyebox::optics {
namespace {

constexpr double kNoiseSigmas = 3;

absl::StatusOr<PatchMean> MeanOver(const LuminanceImage& image, const MeasuringDisk& disk) {
  return MeanOverDisk(image, disk.centre.x_px, disk.centre.y_px, disk.radius_px);
}

absl::Status CheckBright(const PatchMean& bright, const char* what) {
  if (bright.value > kNoiseSigmas * bright.sigma) return absl::OkStatus();
  return Rejected(what, absl::StrCat("luminance ", bright.value, " with sigma ", bright.sigma),
                  "expose longer, or look whether the display was on");
}

// `glare_share`: of the bright luminance, what the instrument lays over the dark.
ContrastFigure MakeContrast(const PatchMean& bright, const PatchMean& dark, double glare_share) {
  ContrastFigure figure;
  figure.bright = bright.value;
  figure.dark = dark.value;
  figure.limit = 1 / (glare_share + kNoiseSigmas * dark.sigma / bright.value);
  figure.only_lower_bound = !(dark.value > kNoiseSigmas * dark.sigma);
  if (figure.only_lower_bound) {
    const double most_dark = std::max(dark.value, 0.0) + kNoiseSigmas * dark.sigma;
    figure.contrast = most_dark > 0 ? bright.value / most_dark : figure.limit;
    return figure;
  }
  figure.contrast = bright.value / dark.value;
  figure.sigma = SigmaOfRatio(bright, dark);
  return figure;
}

absl::Status CheckBoard(ImageSize size, const Checkerboard& board) {
  const bool sized =
      board.square_px > 0 && board.columns > 0 && board.rows > 0 && board.columns * board.rows >= 2;
  const bool measurable = board.measured_fraction > 0 && board.measured_fraction <= 1;
  if (!sized || !measurable) {
    return BadInput("checkerboard",
                    absl::StrCat(board.columns, " x ", board.rows, " squares of ", board.square_px,
                                 " px, measured fraction ", board.measured_fraction),
                    "give at least two squares and a fraction above 0, at most 1");
  }
  const double right = board.corner.x_px + board.columns * board.square_px;
  const double bottom = board.corner.y_px + board.rows * board.square_px;
  if (board.corner.x_px < -0.5 || board.corner.y_px < -0.5 || right > size.width_px - 0.5 ||
      bottom > size.height_px - 0.5) {
    return BadInput("checkerboard", absl::StrCat("ends at (", right, ", ", bottom, ") px"),
                    "give a board that lies within the image");
  }
  return absl::OkStatus();
}

bool IsBright(const Checkerboard& board, int column, int row) {
  return ((column + row) % 2 == 0) == board.first_is_bright;
}

struct BoardMeans {
  PatchMean bright;
  PatchMean dark;
};

// Of squares that count alike: their noise is independent, what they share of scattered light is
// not.
class SquareMean {
 public:
  void Add(const PatchMean& patch) {
    ++squares_;
    value_ += patch.value;
    noise_variance_ += patch.NoiseVariance();
    scatter_sigma_ += patch.scatter_sigma;
  }
  PatchMean Get() const {
    PatchMean mean;
    mean.value = value_ / squares_;
    mean.scatter_sigma = scatter_sigma_ / squares_;
    mean.sigma = std::hypot(std::sqrt(noise_variance_) / squares_, mean.scatter_sigma);
    return mean;
  }

 private:
  int squares_ = 0;
  double value_ = 0;
  double noise_variance_ = 0;
  double scatter_sigma_ = 0;
};

absl::StatusOr<BoardMeans> MeasureSquares(const LuminanceImage& image, const Checkerboard& board) {
  SquareMean bright;
  SquareMean dark;
  const double radius = board.measured_fraction * board.square_px / 2;
  for (int row = 0; row < board.rows; ++row) {
    for (int column = 0; column < board.columns; ++column) {
      EYEBOX_ASSIGN_OR_RETURN(
          const PatchMean patch,
          MeanOverDisk(image, board.corner.x_px + (column + 0.5) * board.square_px,
                       board.corner.y_px + (row + 0.5) * board.square_px, radius));
      (IsBright(board, column, row) ? bright : dark).Add(patch);
    }
  }
  return BoardMeans{bright.Get(), dark.Get()};
}

// A larger scene that holds the board in its middle.
struct Scene {
  ImageSize size;
  Checkerboard drawn;     // all squares
  Checkerboard measured;  // those of the board
};

Scene SceneOf(ImageSize size, const Checkerboard& board, const InstrumentGlare& instrument) {
  if (!board.continued) return {size, board, board};
  const double reach_px = std::min<double>(instrument.kernel.reach_deg / instrument.pitch_deg,
                                           std::max(size.width_px, size.height_px));
  // An even number of squares more on each side leaves the first one as it is.
  const int more = 2 * static_cast<int>(std::ceil(reach_px / board.square_px / 2));
  const int margin = static_cast<int>(std::ceil(more * board.square_px));
  Scene scene{{size.width_px + 2 * margin, size.height_px + 2 * margin}, board, board};
  scene.measured.corner = {board.corner.x_px + margin, board.corner.y_px + margin};
  scene.drawn.corner = {scene.measured.corner.x_px - more * board.square_px,
                        scene.measured.corner.y_px - more * board.square_px};
  scene.drawn.columns += 2 * more;
  scene.drawn.rows += 2 * more;
  return scene;
}

// Dark over bright, of a board without any light in its dark squares.
absl::StatusOr<double> GlareShare(ImageSize size, const Checkerboard& board,
                                  const InstrumentGlare& instrument) {
  const Scene scene = SceneOf(size, board, instrument);
  LuminanceImage seen;
  seen.image = MakeMeasuredImage(scene.size, "relative");
  EYEBOX_ASSIGN_OR_RETURN(seen.image.value, SpreadLight(DrawCheckerboard(scene.size, scene.drawn),
                                                        instrument.pitch_deg, instrument.kernel));
  EYEBOX_ASSIGN_OR_RETURN(const BoardMeans means, MeasureSquares(seen, scene.measured));
  return std::max(means.dark.value, 0.0) / means.bright.value;
}

// Length of [from, to] that lies within the pixel.
double Overlap(double from, double to, int pixel) {
  return std::max(std::min(to, pixel + 0.5) - std::max(from, pixel - 0.5), 0.0);
}

void DrawSquare(double left, double top, double side, Image<float>& image) {
  const auto first = [](double edge) { return std::max(static_cast<int>(std::floor(edge)), 0); };
  for (int y = first(top); y < image.size().height_px && y - 0.5 < top + side; ++y) {
    for (int x = first(left); x < image.size().width_px && x - 0.5 < left + side; ++x) {
      const double covered = Overlap(left, left + side, x) * Overlap(top, top + side, y);
      image.at(x, y) += static_cast<float>(covered);
    }
  }
}

}  // namespace

absl::StatusOr<ContrastFigure> FullFieldContrast(const LuminanceImage& white,
                                                 const LuminanceImage& black,
                                                 const MeasuringDisk& disk) {
  EYEBOX_ASSIGN_OR_RETURN(const PatchMean bright, MeanOver(white, disk));
  EYEBOX_ASSIGN_OR_RETURN(const PatchMean dark, MeanOver(black, disk));
  EYEBOX_RETURN_IF_ERROR(CheckBright(bright, "white field"));
  return MakeContrast(bright, dark, 0);
}

absl::StatusOr<ContrastFigure> CheckerboardContrast(
    const LuminanceImage& image, const Checkerboard& board,
    const std::optional<InstrumentGlare>& instrument) {
  EYEBOX_RETURN_IF_ERROR(CheckBoard(image.image.size(), board));
  EYEBOX_ASSIGN_OR_RETURN(const BoardMeans means, MeasureSquares(image, board));
  EYEBOX_RETURN_IF_ERROR(CheckBright(means.bright, "bright squares"));
  double glare_share = 0;
  if (instrument.has_value()) {
    EYEBOX_ASSIGN_OR_RETURN(glare_share, GlareShare(image.image.size(), board, *instrument));
  }
  return MakeContrast(means.bright, means.dark, glare_share);
}

absl::StatusOr<Checkerboard> CheckerboardAround(ImageSize size, const PixelPoint& axis,
                                                double square_px) {
  if (!(square_px > 0 && std::isfinite(square_px))) {
    return BadInput("checkerboard", absl::StrCat("squares of ", square_px, " px"),
                    "give a side above 0");
  }
  const auto whole = [square_px](double before, double after) {
    return static_cast<int>(std::floor(std::min(before, after) / square_px));
  };
  const int across = whole(axis.x_px + 0.5, size.width_px - 0.5 - axis.x_px);
  const int down = whole(axis.y_px + 0.5, size.height_px - 0.5 - axis.y_px);
  if (across < 1 || down < 1) {
    return Rejected(
        "checkerboard",
        absl::StrCat("squares of ", square_px, " px do not fit around (", axis.x_px, ", ",
                     axis.y_px, ") in ", size.width_px, " x ", size.height_px, " pixels"),
        "show smaller squares");
  }
  Checkerboard board;
  board.corner = {axis.x_px - across * square_px, axis.y_px - down * square_px};
  board.square_px = square_px;
  board.columns = 2 * across;
  board.rows = 2 * down;
  board.first_is_bright = (across + down) % 2 == 0;
  board.continued = true;
  return board;
}

Image<float> DrawCheckerboard(ImageSize size, const Checkerboard& board) {
  Image<float> image(size);
  for (int row = 0; row < board.rows; ++row) {
    for (int column = 0; column < board.columns; ++column) {
      if (!IsBright(board, column, row)) continue;
      DrawSquare(board.corner.x_px + column * board.square_px,
                 board.corner.y_px + row * board.square_px, board.square_px, image);
    }
  }
  return image;
}

absl::StatusOr<GlareFigure> BlackSpotGlare(const LuminanceImage& with_spot,
                                           const LuminanceImage& field, const BlackSpot& spot,
                                           const std::optional<ScatterKernel>& instrument) {
  EYEBOX_ASSIGN_OR_RETURN(const PatchMean dark, MeanOver(with_spot, spot.disk));
  EYEBOX_ASSIGN_OR_RETURN(const PatchMean bright, MeanOver(field, spot.disk));
  EYEBOX_RETURN_IF_ERROR(CheckBright(bright, "bright field"));
  GlareFigure figure;
  figure.share = dark.value / bright.value;
  figure.sigma = SigmaOfRatio(dark, bright);
  if (instrument.has_value()) {
    const SpotPhotometer eye{*instrument, 0};
    EYEBOX_ASSIGN_OR_RETURN(const double spot_only,
                            ReadDisk(eye, {spot.spot_diameter_deg, 0, 1, spot.field_radius_deg}));
    EYEBOX_ASSIGN_OR_RETURN(const double whole, ReadDisk(eye, {0, 0, 1, spot.field_radius_deg}));
    figure.instrument_share = spot_only / whole;
  }
  figure.floor = figure.instrument_share + kNoiseSigmas * figure.sigma;
  return figure;
}

}  // namespace eyebox::optics
