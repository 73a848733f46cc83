#include <array>
#include <string_view>

#include "capture/base/status.h"
#include "capture/photodiode/iio/iio_photodiode.h"
#include "capture/photodiode/photodiode.h"
#include "capture/photodiode/replay/replay_photodiode.h"
#include "capture/photodiode/serial/serial_photodiode.h"
#include "capture/photodiode/sim/sim_photodiode.h"

namespace eyebox::capture {
namespace {

struct Scheme {
  std::string_view name;
  absl::StatusOr<std::unique_ptr<Photodiode>> (*open)(const PhotodiodeConfig&, const Clock*);
};

constexpr std::array<Scheme, 4> kSchemes = {
    Scheme{"iio", OpenIioPhotodiode}, Scheme{"serial", OpenSerialPhotodiode},
    Scheme{"sim", OpenSimPhotodiode}, Scheme{"replay", OpenReplayPhotodiode}};

}  // namespace

absl::StatusOr<std::unique_ptr<Photodiode>> OpenPhotodiode(const PhotodiodeConfig& config,
                                                           const Clock* clock) {
  const std::string_view uri = config.uri;
  std::string known;
  for (const Scheme& scheme : kSchemes) {
    if (uri.starts_with(scheme.name) && uri.substr(scheme.name.size()).starts_with(':')) {
      return scheme.open(config, clock);
    }
    known.append(" ").append(scheme.name).append(":");
  }
  return BadInput("photodiode_uri '" + config.uri + "'", "has no scheme that is known here",
                  "start it with one of" + known);
}

std::vector<std::string> PhotodiodeSchemes() {
  std::vector<std::string> names;
  for (const Scheme& scheme : kSchemes) names.emplace_back(scheme.name);
  return names;
}

}  // namespace eyebox::capture
