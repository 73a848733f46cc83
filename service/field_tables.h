// One table or many for the field of a headset.
#ifndef EYEBOX_SERVICE_FIELD_TABLES_H_
#define EYEBOX_SERVICE_FIELD_TABLES_H_

#include <filesystem>
#include <optional>
#include <string>

#include "absl/status/statusor.h"
#include "eyebox/v1/table.pb.h"
#include "fit/cube/cube_set.h"
#include "service/watcher.h"

namespace eyebox::service {

struct FieldTablesRequest {
  std::filesystem::path recording;    // either a recording, whose field is fitted,
  std::optional<std::string> series;  //
  std::filesystem::path field;        // or the folder that `eyebox run` or `fit --out` wrote
  // "all", or "central D": places less than D / 2 degrees from the principal point.
  std::string region = "all";
  double focal_length_px = 0;  // of a field folder, where the region is in degrees
  int place_px = 8;            // side of a place: the mean of its pixels is what is judged
  fit::CubeSetOptions design;
  std::filesystem::path out;  // folder for single.cube, table_1.cube, ... and the maps
};

// A field folder holds field_k.npy and field_delta.npy, field_k_sigma.npy and field_delta_sigma.npy
// where known, activation.json with the common exponent, or field_gamma.npy with one a pixel.
// Errors: those of the recording and of DesignCubeSet; NotFound, InvalidArgument (a map of another
// size, a region that is none or needs a geometry that is not known).
absl::StatusOr<v1::CubeSetResult> DesignFieldTables(const FieldTablesRequest& request,
                                                    const Watcher& watcher);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_FIELD_TABLES_H_
