// A camera's geometry from views of a dot grid or a ChArUco board.
#ifndef EYEBOX_SERVICE_GEOMETRY_H_
#define EYEBOX_SERVICE_GEOMETRY_H_

#include <filesystem>
#include <optional>
#include <string>
#include <variant>

#include "absl/status/statusor.h"
#include "eyebox/v1/geometry.pb.h"
#include "optics/geometry/calibrate_lens.h"
#include "optics/geometry/entrance_pupil.h"
#include "optics/geometry/find_charuco.h"
#include "optics/geometry/find_dots.h"
#include "service/watcher.h"

namespace eyebox::service {

struct DotTarget {
  optics::DotGrid grid;
  double pitch_mm = 0;
};

// A grid of bright dots on the headset's display.
struct DisplayedGrid {
  std::filesystem::path frame;  // TIFF or PNG of it, through the headset's optics
  optics::DotGrid grid;
  double first_x_px = 0;  // display pixel of the upper left dot
  double first_y_px = 0;
  double pitch_px = 0;
  std::optional<int> order;  // of the polynomials; chosen by cross-validation unless given
};

struct GeometryRequest {
  std::filesystem::path source;       // folder of TIFF or PNG views, or a recording
  std::optional<std::string> series;  // of the recording: each of its light captures is a view
  std::variant<DotTarget, optics::CharucoBoard> target;
  optics::LensCalibrationOptions lens;
  std::optional<optics::EntrancePupil> pupil;
  optics::PupilSurroundings surroundings;
  std::optional<DisplayedGrid> displayed;
};

// Views in which the target is not found are left out with a warning; if fewer than 3 are left the
// first reason is the error.
// Errors: NotFound, InvalidArgument (views of several sizes, no views, options), those of the
// recording, of CalibrateLens and of RegisterDisplay.
absl::StatusOr<v1::GeometryResult> CalibrateGeometry(const GeometryRequest& request,
                                                     const Watcher& watcher);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_GEOMETRY_H_
