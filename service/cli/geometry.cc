#include "service/geometry.h"

#include <cstdio>
#include <map>
#include <string>

#include "absl/strings/str_join.h"
#include "capture/base/file.h"
#include "capture/base/status.h"
#include "service/cli/command.h"
#include "service/cli/terminal.h"
#include "service/result_json.h"

namespace eyebox::service::cli {
namespace {

const std::map<std::string, optics::LensModel> kLenses = {
    {"pinhole", optics::LensModel::kPinhole}, {"equidistant", optics::LensModel::kEquidistant}};

struct Options {
  GeometryRequest request;
  std::string target = "dots";
  DotTarget dots;
  optics::CharucoBoard charuco;
  int columns = 0;
  int rows = 0;
  double pitch_mm = 0;
  optics::EntrancePupil pupil;
  DisplayedGrid displayed;
  std::string out;
  bool json = false;
};

void PrintViews(const v1::GeometryResult& result) {
  for (const v1::GeometryView& view : result.views()) {
    std::printf("  %s: %d points, %.3f px rms, tilted %.0f deg\n", view.source().c_str(),
                view.points(), view.reprojection_rms_px(), view.tilt_deg());
  }
  std::printf("  %s; reprojection %.3f px rms over %d points\n", result.model().c_str(),
              result.reprojection_rms_px(), result.points());
  std::printf("  field %.2f to %.2f deg across, %.2f to %.2f deg up; %.4f sr\n",
              result.field_deg(0), result.field_deg(1), result.field_deg(2), result.field_deg(3),
              result.solid_angle_sr());
  if (!result.has_registration()) return;
  std::printf("  display: order %d, residual %.4f deg rms over %d dots\n",
              result.registration().order(), result.registration().residual_rms_deg(),
              result.registration().points());
}

GeometryRequest RequestOf(const Options& options) {
  GeometryRequest request = options.request;
  if (options.target == "charuco") {
    optics::CharucoBoard board = options.charuco;
    board.columns = options.columns;
    board.rows = options.rows;
    board.square_mm = options.pitch_mm;
    request.target = board;
  } else {
    DotTarget dots = options.dots;
    dots.grid.columns = options.columns;
    dots.grid.rows = options.rows;
    dots.pitch_mm = options.pitch_mm;
    request.target = dots;
  }
  request.pupil = options.pupil;
  if (!options.displayed.frame.empty()) {
    request.displayed = options.displayed;
    request.displayed->grid.bright = true;
  }
  return request;
}

// What was not accepted is written and printed too, so that one can see why.
absl::Status Run(const Options& options) {
  EYEBOX_ASSIGN_OR_RETURN(const v1::GeometryResult result,
                          CalibrateGeometry(RequestOf(options), TerminalWatcher()));
  PrintWarnings(result.warnings());
  EYEBOX_ASSIGN_OR_RETURN(const std::string json, ToJson(result));
  if (!options.out.empty()) EYEBOX_RETURN_IF_ERROR(WriteFileAtomically(options.out, json));
  if (options.json) {
    EYEBOX_RETURN_IF_ERROR(PrintJson(result));
  } else {
    PrintParameters(result.parameters());
    PrintViews(result);
  }
  if (result.accepted()) return absl::OkStatus();
  return Rejected(options.request.source.string(), absl::StrJoin(result.reasons(), "; "),
                  "the geometry will not be used as it is");
}

void BindTarget(CLI::App& command, Options& options) {
  command.add_option("source", options.request.source, "Folder of views (PNG, TIFF) or recording")
      ->required();
  command.add_option("--series", options.request.series, "Series of the recording");
  command.add_option("--target", options.target, "dots or charuco")
      ->check(CLI::IsMember({"dots", "charuco"}))
      ->capture_default_str();
  command.add_option("--columns", options.columns, "Dots, or squares, across")->required();
  command.add_option("--rows", options.rows, "Dots, or squares, down")->required();
  command.add_option("--pitch", options.pitch_mm, "Distance of dots, or side of a square, mm")
      ->required();
  command.add_flag("--bright", options.dots.grid.bright, "Dots are brighter than their ground");
  command.add_option("--marker", options.charuco.marker_mm, "Side of a marker, mm (charuco)");
  command.add_option("--marker-bits", options.charuco.marker_bits, "4, 5 or 6 (charuco)")
      ->capture_default_str();
}

void BindLens(CLI::App& command, Options& options) {
  command.add_option("--lens", options.request.lens.lens, "pinhole or equidistant (wide fields)")
      ->transform(OneOf(kLenses));
  command
      .add_option("--distortion-terms", options.request.lens.distortion_terms,
                  "Free ones of k1 k2 p1 p2 k3, or of k1 k2 k3 k4")
      ->capture_default_str();
  command
      .add_option("--largest-rms", options.request.lens.largest_rms_px,
                  "Reprojection rms beyond which it is not accepted, px")
      ->capture_default_str();
}

void BindPupil(CLI::App& command, Options& options) {
  optics::EntrancePupil& pupil = options.pupil;
  command.add_option("--pupil", pupil.diameter_mm, "Diameter of the camera's pupil, mm");
  command.add_option("--right", pupil.right_mm, "Pupil right of the eye point, mm");
  command.add_option("--up", pupil.up_mm, "Pupil above the eye point, mm");
  command.add_option("--forward", pupil.forward_mm, "Pupil before the eye point, mm");
  command.add_option("--yaw", pupil.yaw_deg, "Camera turned right, deg");
  command.add_option("--pitch-angle", pupil.pitch_deg, "Camera turned up, deg");
  command.add_option("--roll", pupil.roll_deg, "Camera turned clockwise, deg");
  optics::PupilSurroundings& known = options.request.surroundings;
  command.add_option("--focal-length", known.focal_length_mm, "Of the camera's lens, mm");
  command.add_option("--f-number", known.f_number, "Of the camera's lens");
  command.add_option("--eye-box", known.exit_pupil_mm, "Diameter of the headset's eye box, mm");
  command.add_option("--eye-pupil", known.eye_pupil_mm, "Of the eye that is stood for, mm");
  command.add_option("--image-distance", known.image_distance_m, "Of the virtual image, m");
}

void BindDisplay(CLI::App& command, Options& options) {
  DisplayedGrid& displayed = options.displayed;
  auto* frame = command.add_option("--display-frame", displayed.frame,
                                   "Frame of bright dots on the display: registers it");
  for (auto* option :
       {command.add_option("--display-columns", displayed.grid.columns, "Dots across"),
        command.add_option("--display-rows", displayed.grid.rows, "Dots down"),
        command.add_option("--display-x", displayed.first_x_px, "Display column of the first dot"),
        command.add_option("--display-y", displayed.first_y_px, "Display row of the first dot"),
        command.add_option("--display-pitch", displayed.pitch_px, "Display pixels between dots")}) {
    frame->needs(option);
  }
  command.add_option("--display-order", displayed.order,
                     "Order of the polynomials (default: by cross-validation)");
}

}  // namespace

void AddGeometry(CLI::App& app, Work& work) {
  AddCommand<Options>(
      app, work, "geometry", "Calibrate where the camera's pixels look, from views of a target.",
      "eyebox geometry views --columns 11 --rows 9 --pitch 8 --lens equidistant --out "
      "geometry.json\n"
      "  eyebox uniformity recording --geometry geometry.json --out maps",
      [](CLI::App& command, Options& options) {
        BindTarget(command, options);
        BindLens(command, options);
        BindPupil(command, options);
        BindDisplay(command, options);
        command.add_option("--out", options.out, "Write the result there, as geometry.json");
        command.add_flag("--json", options.json, "Print the result as JSON on stdout");
      },
      Run);
}

}  // namespace eyebox::service::cli
