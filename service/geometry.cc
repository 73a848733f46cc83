#include "service/geometry.h"

#include <cmath>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"
#include "optics/geometry/registration.h"
#include "service/results/geometry.h"
#include "service/results/parameter.h"
#include "service/steps/views.h"

namespace eyebox::service {
namespace {

constexpr size_t kFewestViews = 3;  // that CalibrateLens() takes

absl::StatusOr<optics::ViewPoints> FindTarget(const GeometryRequest& request,
                                              const Image<double>& view,
                                              const std::string& source) {
  if (const auto* board = std::get_if<optics::CharucoBoard>(&request.target)) {
    return optics::FindCharuco(view, *board, source);
  }
  const DotTarget& target = std::get<DotTarget>(request.target);
  if (!(target.pitch_mm > 0) || !std::isfinite(target.pitch_mm)) {
    return BadInput("dot grid", absl::StrCat("pitch ", target.pitch_mm, " mm"),
                    "give the distance of neighbouring dots");
  }
  EYEBOX_ASSIGN_OR_RETURN(const auto dots, optics::FindDots(view, target.grid, source));
  optics::ViewPoints points{source, {}};
  for (const optics::Dot& dot : dots) {
    points.points.push_back({.x_mm = target.pitch_mm * dot.column,
                             .y_mm = target.pitch_mm * dot.row,
                             .pixel = dot.centre});
  }
  return points;
}

struct Views {
  ImageSize size;
  std::vector<optics::ViewPoints> points;
  std::vector<std::string> warnings;  // why views were left out
};

absl::StatusOr<Views> FindTargets(const GeometryRequest& request, const Watcher& watcher) {
  Views views;
  absl::Status first_reason;
  const auto visit = [&](const std::string& source, const Image<double>& view) -> absl::Status {
    EYEBOX_RETURN_IF_ERROR(watcher.Reach(0, absl::StrCat("target in ", source)));
    if (views.size.PixelCount() == 0) views.size = view.size();
    if (view.size() != views.size) {
      return BadInput(source, "has another size than the first view",
                      "give views of one camera with one region of interest");
    }
    auto points = FindTarget(request, view, source);
    if (points.ok()) {
      views.points.push_back(*std::move(points));
    } else if (absl::IsFailedPrecondition(points.status())) {
      views.warnings.push_back(absl::StrCat("left out: ", points.status().message()));
      first_reason.Update(points.status());
    } else {
      return points.status();
    }
    return absl::OkStatus();
  };
  EYEBOX_RETURN_IF_ERROR(VisitViews(request.source, request.series, visit));
  if (views.points.size() < kFewestViews) EYEBOX_RETURN_IF_ERROR(first_reason);
  return views;
}

absl::Status Register(const DisplayedGrid& displayed, const optics::ViewGeometry& geometry,
                      v1::GeometryResult& result) {
  const std::string source = displayed.frame.filename().string();
  EYEBOX_ASSIGN_OR_RETURN(const Image<double> view, ReadView(displayed.frame));
  if (view.size() != geometry.camera.size) {
    return BadInput(source, "has another size than the views of the target",
                    "give a frame of the same camera with the same region of interest");
  }
  EYEBOX_ASSIGN_OR_RETURN(const auto dots, optics::FindDots(view, displayed.grid, source));
  std::vector<optics::DisplayedDot> seen;
  double along_row = 0;  // of the camera, as columns of the display rise
  double along_column = 0;
  for (const optics::Dot& dot : dots) {
    const auto angle = geometry.FieldAngleOf(dot.centre);
    if (!angle) continue;
    seen.push_back({{displayed.first_x_px + displayed.pitch_px * dot.column,
                     displayed.first_y_px + displayed.pitch_px * dot.row},
                    *angle});
    along_row += (2 * dot.column - displayed.grid.columns + 1) * dot.centre.x_px;
    along_column += (2 * dot.column - displayed.grid.columns + 1) * dot.centre.y_px;
  }
  if (!(along_row > std::abs(along_column))) {
    return Rejected(source, "shows the display on its side", "turn the camera upright");
  }
  EYEBOX_ASSIGN_OR_RETURN(const optics::Registration registration,
                          optics::RegisterDisplay(seen, displayed.order));
  AddRegistration(registration, static_cast<int>(seen.size()), result);
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<v1::GeometryResult> CalibrateGeometry(const GeometryRequest& request,
                                                     const Watcher& watcher) {
  const optics::EntrancePupil pupil = request.pupil.value_or(optics::EntrancePupil{});
  EYEBOX_RETURN_IF_ERROR(pupil.Validate());
  EYEBOX_ASSIGN_OR_RETURN(const Views views, FindTargets(request, watcher));
  EYEBOX_RETURN_IF_ERROR(watcher.Reach(0.5, "lens"));
  EYEBOX_ASSIGN_OR_RETURN(const optics::LensCalibration calibration,
                          optics::CalibrateLens(views.points, views.size, request.lens));
  EYEBOX_ASSIGN_OR_RETURN(v1::GeometryResult result, DescribeGeometry(calibration, request.pupil));
  AddAll(*result.mutable_warnings(), views.warnings);
  AddAll(*result.mutable_warnings(), optics::PupilWarnings(pupil, request.surroundings));
  if (request.displayed) {
    EYEBOX_RETURN_IF_ERROR(watcher.Reach(0.9, "registration of the display"));
    EYEBOX_RETURN_IF_ERROR(Register(*request.displayed, {calibration.model, pupil}, result));
  }
  if (watcher.progress) watcher.progress({1, "done"});
  return result;
}

}  // namespace eyebox::service
