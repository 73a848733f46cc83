#include "service/field_tables.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "capture/base/file.h"
#include "capture/base/npy.h"
#include "capture/base/status.h"
#include "capture/recording/reader.h"
#include "fit/cube/places.h"
#include "fit/cube/table_file.h"
#include "fit/field/common_exponent.h"
#include "service/artifacts.h"
#include "service/result_json.h"
#include "service/results/cube.h"
#include "service/results/parameter.h"
#include "service/steps/calibrate.h"
#include "service/steps/levels.h"
#include "service/steps/within.h"

namespace eyebox::service {
namespace {

// Maps of the field fit, one value a pixel.
struct FieldMaps {
  ImageSize size;
  std::vector<float> gain, offset;
  std::vector<float> offset_sigma;  // empty where not known
  std::vector<float> gamma;         // one, or one a pixel
  double focal_length_px = 0;       // 0 where not known
  double centre_x_px = 0;
  double centre_y_px = 0;
};

absl::StatusOr<FieldMaps> FitField(const FieldTablesRequest& request, const Watcher& watcher) {
  EYEBOX_ASSIGN_OR_RETURN(const auto reader, capture::RecordingReader::Open(request.recording));
  EYEBOX_ASSIGN_OR_RETURN(const std::string series, ChooseSeries(*reader, request.series));
  EYEBOX_ASSIGN_OR_RETURN(const optics::Calibration calibration,
                          CalibrateCamera(*reader, watcher.Part(0, 0.4)));
  EYEBOX_ASSIGN_OR_RETURN(const MeasuredLevels levels,
                          ReduceGreyLevels(*reader, series, calibration, watcher.Part(0.4, 0.9)));
  EYEBOX_ASSIGN_OR_RETURN(const fit::CommonExponentFit fit, fit::FitCommonExponent(levels.Field()));
  FieldMaps maps{levels.size,
                 {fit.gain.begin(), fit.gain.end()},
                 {fit.offset.begin(), fit.offset.end()},
                 {fit.offset_sigma.begin(), fit.offset_sigma.end()},
                 {static_cast<float>(fit.gamma)}};
  if (const auto& geometry = reader->Header().geometry) {
    maps.focal_length_px = geometry->focal_length_px;
    maps.centre_x_px = geometry->principal_x_px;
    maps.centre_y_px = geometry->principal_y_px;
  }
  return maps;
}

absl::StatusOr<std::vector<float>> ReadMap(const std::filesystem::path& file, ImageSize size) {
  EYEBOX_ASSIGN_OR_RETURN(const Image<float> map, ReadNpy(file));
  if (map.size() == size) return std::vector<float>(map.pixels().begin(), map.pixels().end());
  return BadInput(file.string(), "has another size than field_k.npy",
                  "give the maps of one and the same fit");
}

absl::StatusOr<float> CommonGamma(const std::filesystem::path& file) {
  v1::ActivationResult activation;
  EYEBOX_RETURN_IF_ERROR(ReadJson(file, activation));
  for (const v1::Parameter& parameter : activation.field().parameters()) {
    if (parameter.name() != "gamma") continue;
    if (parameter.value() > 0 && std::isfinite(parameter.value())) {
      return static_cast<float>(parameter.value());
    }
  }
  return BadInput(file.string(), "field.parameters holds no gamma above 0",
                  "give the folder that `eyebox run` wrote, or add field_gamma.npy");
}

absl::StatusOr<FieldMaps> ReadField(const FieldTablesRequest& request) {
  const std::filesystem::path& folder = request.field;
  EYEBOX_ASSIGN_OR_RETURN(const Image<float> gain, ReadNpy(folder / "field_k.npy"));
  FieldMaps maps;
  maps.size = gain.size();
  maps.gain.assign(gain.pixels().begin(), gain.pixels().end());
  EYEBOX_ASSIGN_OR_RETURN(maps.offset, ReadMap(folder / "field_delta.npy", maps.size));
  if (std::filesystem::exists(folder / "field_delta_sigma.npy")) {
    EYEBOX_ASSIGN_OR_RETURN(maps.offset_sigma,
                            ReadMap(folder / "field_delta_sigma.npy", maps.size));
  }
  if (std::filesystem::exists(folder / "field_gamma.npy")) {
    EYEBOX_ASSIGN_OR_RETURN(maps.gamma, ReadMap(folder / "field_gamma.npy", maps.size));
  } else {
    EYEBOX_ASSIGN_OR_RETURN(const float gamma, CommonGamma(folder / "activation.json"));
    maps.gamma = {gamma};
  }
  maps.focal_length_px = request.focal_length_px;
  maps.centre_x_px = (maps.size.width_px - 1) / 2.0;
  maps.centre_y_px = (maps.size.height_px - 1) / 2.0;
  return maps;
}

// Means over the valid pixels of each place.
std::vector<fit::PlaceResponse> PlacesOf(const FieldMaps& maps, const fit::PlaceGrid& grid) {
  std::vector<fit::PlaceResponse> places;
  for (size_t index = 0; index < grid.size().PixelCount(); ++index) {
    const std::vector<size_t> pixels = grid.PixelsOf(index);
    double count = 0;
    double gain = 0;
    double offset = 0;
    double variance = 0;
    double gamma = 0;
    for (size_t pixel : pixels) {
      const float pixel_gamma = maps.gamma.size() == 1 ? maps.gamma[0] : maps.gamma[pixel];
      if (!(maps.gain[pixel] > 0) || std::isnan(maps.offset[pixel]) || !(pixel_gamma > 0)) {
        continue;
      }
      ++count;
      gain += maps.gain[pixel];
      offset += maps.offset[pixel];
      gamma += pixel_gamma;
      if (!maps.offset_sigma.empty()) variance += std::pow(maps.offset_sigma[pixel], 2);
    }
    fit::PlaceResponse place{std::numeric_limits<double>::quiet_NaN(), 0, 0};
    if (2 * count >= static_cast<double>(pixels.size())) {
      place = {offset / gain, std::sqrt(variance) / gain, gamma / count};
    }
    places.push_back(place);
  }
  return places;
}

absl::StatusOr<std::vector<uint8_t>> RegionOf(const std::string& region, const FieldMaps& maps,
                                              const fit::PlaceGrid& grid) {
  std::vector<uint8_t> inside(grid.size().PixelCount(), 1);
  if (region == "all") return inside;
  constexpr std::string_view kCentral = "central ";
  double diameter_deg = 0;
  const char* const end = region.data() + region.size();
  const bool is_central = region.starts_with(kCentral);
  const auto [stop, error] =
      std::from_chars(region.data() + (is_central ? kCentral.size() : 0), end, diameter_deg);
  if (!is_central || error != std::errc() || stop != end || !(diameter_deg > 0) ||
      diameter_deg >= 180) {
    return BadInput("region", "\"" + region + "\" is none",
                    "give all, or central D with D the diameter in degrees");
  }
  if (!(maps.focal_length_px > 0)) {
    return BadInput("region", "degrees need a geometry, and none is known",
                    "give a recording with a geometry, or --focal-length");
  }
  const double radius_px =
      maps.focal_length_px * std::tan(diameter_deg / 2 * std::numbers::pi / 180);
  for (size_t i = 0; i < inside.size(); ++i) {
    const auto [x, y] = grid.CentreOf(i);
    inside[i] = std::hypot(x - maps.centre_x_px, y - maps.centre_y_px) <= radius_px ? 1 : 0;
  }
  return inside;
}

absl::Status DescribeTable(const fit::RegionTable& region, const std::string& name, int index,
                           const std::filesystem::path& out, v1::RegionTable& message) {
  EYEBOX_ASSIGN_OR_RETURN(const std::string bytes, fit::EncodeTable(region.table));
  const bool is_strip = region.table.target == fit::TableTarget::kPps;
  const std::string file = name + (is_strip ? ".png" : ".cube");
  EYEBOX_RETURN_IF_ERROR(WriteFileAtomically(out / file, bytes));
  // What a fit at this place would have given, in units of its gain.
  v1::ActivationResult activation;
  activation.set_luminance_unit("relative");
  AddParameter(*activation.mutable_parameters(), "minimum_luminance", region.offset_over_gain, 0,
               "relative");
  AddParameter(*activation.mutable_parameters(), "luminance_range", 1, 0, "relative");
  *message.mutable_table() = DescribeCube(region.table, activation, file, bytes);
  message.set_index(index);
  message.set_offset_over_gain(region.offset_over_gain);
  message.set_gamma(region.gamma);
  message.set_places(static_cast<int>(region.places));
  message.set_max_relative(region.max_relative);
  message.set_max_relative_sigma(region.max_relative_sigma);
  return absl::OkStatus();
}

std::string Explain(const FieldMaps& maps, const fit::CubeSet& set) {
  std::string text = absl::StrFormat(
      "A place answers with k v^gamma + delta. Differences in k alone scale luminance and leave "
      "one "
      "table right everywhere; what parts places here is delta / k");
  text += maps.gamma.size() == 1 ? absl::StrFormat(" (gamma is common, %.4f).", maps.gamma[0])
                                 : std::string(" and gamma, which differs from place to place.");
  absl::StrAppendFormat(&text, " The best single table leaves up to %.2f %% in the region.",
                        100 * set.single.max_relative);
  return text;
}

absl::Status DescribeMaps(const fit::CubeSet& set, const fit::PlaceGrid& grid,
                          const std::filesystem::path& out, v1::CubeSetResult& result) {
  const std::vector<float> regions(set.table_of.begin(), set.table_of.end());
  struct Map {
    const char* name;
    const std::vector<float>& values;
  };
  for (const Map& map :
       {Map{"single_error", set.single_error}, Map{"single_error_sigma", set.single_error_sigma},
        Map{"regions", regions}}) {
    Image<float> image(grid.size());
    std::ranges::copy(map.values, image.pixels().begin());
    EYEBOX_ASSIGN_OR_RETURN(*result.add_maps(),
                            WriteMap(out, absl::StrCat(map.name, ".npy"), map.name, "1", image));
  }
  return absl::OkStatus();
}

absl::StatusOr<v1::CubeSetResult> Describe(const FieldTablesRequest& request, const FieldMaps& maps,
                                           const fit::PlaceGrid& grid, const fit::CubeSet& set) {
  v1::CubeSetResult result;
  auto& parameters = *result.mutable_parameters();
  AddParameter(parameters, "places", static_cast<double>(set.single.places), 0, "1");
  AddParameter(parameters, "single_max_relative", set.single.max_relative,
               set.single.max_relative_sigma, "1");
  AddParameter(parameters, "single_rms_relative", set.single_rms, 0, "1");
  AddParameter(parameters, "tables", static_cast<double>(set.tables.size()), 0, "1");
  AddParameter(parameters, "tables_at_least", static_cast<double>(set.at_least), 0, "1");
  AddParameter(parameters, "tolerance", request.design.tolerance, 0, "1");
  result.set_region(request.region);
  EYEBOX_RETURN_IF_ERROR(
      DescribeTable(set.single, "single", 0, request.out, *result.mutable_single()));
  for (size_t i = 0; i < set.tables.size(); ++i) {
    EYEBOX_RETURN_IF_ERROR(DescribeTable(set.tables[i], absl::StrCat("table_", i + 1),
                                         static_cast<int>(i) + 1, request.out,
                                         *result.add_tables()));
  }
  result.set_proven_smallest(set.tables.size() == set.at_least);
  EYEBOX_RETURN_IF_ERROR(DescribeMaps(set, grid, request.out, result));
  result.set_place_px(grid.side_px);
  result.set_explanation(Explain(maps, set));
  return result;
}

absl::StatusOr<v1::CubeSetResult> Design(const FieldTablesRequest& request,
                                         const Watcher& watcher) {
  if (request.place_px < 1) {
    return BadInput("place", absl::StrCat(request.place_px, " is no size"), "give 1 pixel or more");
  }
  EYEBOX_ASSIGN_OR_RETURN(const FieldMaps maps, request.recording.empty()
                                                    ? ReadField(request)
                                                    : FitField(request, watcher.Part(0, 0.9)));
  const fit::PlaceGrid grid{maps.size, request.place_px};
  EYEBOX_ASSIGN_OR_RETURN(const std::vector<uint8_t> inside, RegionOf(request.region, maps, grid));
  EYEBOX_ASSIGN_OR_RETURN(const fit::CubeSet set,
                          fit::DesignCubeSet(PlacesOf(maps, grid), inside, request.design));
  return Describe(request, maps, grid, set);
}

}  // namespace

absl::StatusOr<v1::CubeSetResult> DesignFieldTables(const FieldTablesRequest& request,
                                                    const Watcher& watcher) {
  auto result = Design(request, watcher);
  if (result.ok()) {
    if (watcher.progress) watcher.progress({1, "done"});
    return result;
  }
  return Within(request.recording.empty() ? request.field : request.recording, result.status());
}

}  // namespace eyebox::service
