// The calibrated geometry that a command names, or that a recording keeps.
#ifndef EYEBOX_SERVICE_STEPS_KNOWN_GEOMETRY_H_
#define EYEBOX_SERVICE_STEPS_KNOWN_GEOMETRY_H_

#include <filesystem>
#include <optional>

#include "absl/status/statusor.h"
#include "eyebox/v1/results.pb.h"
#include "optics/geometry/entrance_pupil.h"
#include "optics/uniformity/uniformity_map.h"

namespace eyebox::service {

inline constexpr char kGeometryFile[] = "geometry.json";  // of a recording

// `asked` where a command names one, else kGeometryFile in `recording`, else nothing.
// Errors: NotFound, InvalidArgument (not what eyebox geometry writes), FailedPrecondition (it was
// not accepted).
absl::StatusOr<std::optional<optics::ViewGeometry>> KnownGeometry(
    const std::filesystem::path& recording, const std::filesystem::path& asked);

// Copies `file` into `recording` as kGeometryFile; does nothing for an empty name.
// Errors: those of KnownGeometry(), the errno of the disk.
absl::Status KeepGeometry(const std::filesystem::path& file,
                          const std::filesystem::path& recording);

// Gives the points of `result` their field angles, and adds raw g over a regular grid of them:
// uniformity_g_field.npy with its sigma in `folder` unless it is empty, and field_left_deg,
// field_top_deg, field_step_deg, which say where its cells are centred. The step is the least of
// 1, 2, 5, 10 ... that is at least two pixels on the axis. Does nothing without a geometry.
// Errors: InvalidArgument (it is of another size than the map), those of writing.
absl::Status AddFieldMap(const std::optional<optics::ViewGeometry>& geometry,
                         const optics::UniformityMap& map, const std::filesystem::path& folder,
                         v1::UniformityResult& result);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_STEPS_KNOWN_GEOMETRY_H_
