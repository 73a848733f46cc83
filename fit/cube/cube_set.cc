#include "fit/cube/cube_set.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "capture/base/status.h"
#include "fit/cube/response_cover.h"

namespace eyebox::fit {
namespace {

constexpr int kPointsThroughTable = 257;

Response ResponseOf(const PlaceResponse& place) { return {place.offset_over_gain, place.gamma}; }

// A finished table, and what it shows at the values at which places are judged.
struct Finished {
  RegionTable region;
  std::vector<double> xs;
  std::vector<double> drives;

  double ErrorAt(const Response& place) const { return DepartureAt(place, xs, drives); }
  double SigmaAt(const PlaceResponse& place) const {
    const Response here = ResponseOf(place);
    const double error = ErrorAt(here);
    const double sigma = place.offset_over_gain_sigma;
    return std::max(std::abs(ErrorAt({here.offset + sigma, here.gamma}) - error),
                    std::abs(ErrorAt({here.offset - sigma, here.gamma}) - error));
  }
};

absl::StatusOr<Finished> Finish(const Response& response, const CubeSetOptions& options) {
  Finished finished;
  const Activation activation = {.minimum_luminance = std::max(response.offset, 0.0),
                                 .luminance_range = 1,
                                 .cutoff_drive = 0,
                                 .gamma = response.gamma};
  EYEBOX_ASSIGN_OR_RETURN(finished.region.table,
                          DesignTable(activation, options.target, options.size, options.design));
  finished.region.offset_over_gain = activation.minimum_luminance;
  finished.region.gamma = response.gamma;
  finished.xs = RangeAbove(options.design.u_from, response.offset, kPointsThroughTable);
  const double from = finished.xs.front();
  for (double knot_u : finished.region.table.knots_u) {
    const double x = knot_u / options.design.white_u;
    if (x > from && x < 1) finished.xs.push_back(x);  // where the error has its cusps
  }
  for (double x : finished.xs) {
    finished.drives.push_back(DriveThroughTable(finished.region.table, x * options.design.white_u));
  }
  return finished;
}

void Serve(Finished& finished, const PlaceResponse& place, double error) {
  ++finished.region.places;
  if (error < finished.region.max_relative) return;
  finished.region.max_relative = error;
  finished.region.max_relative_sigma = finished.SigmaAt(place);
}

class Designer {
 public:
  Designer(std::span<const PlaceResponse> places, std::span<const uint8_t> in_region,
           const CubeSetOptions& options)
      : places_(places), options_(options) {
    for (size_t i = 0; i < places.size(); ++i) {
      if (in_region[i] == 0 || std::isnan(places[i].offset_over_gain)) continue;
      members_.push_back(i);
      responses_.push_back(ResponseOf(places[i]));
    }
  }

  bool empty() const { return members_.empty(); }

  absl::Status DesignSingle(CubeSet& set) const {
    const double from = options_.design.u_from;
    EYEBOX_ASSIGN_OR_RETURN(Finished single, Finish(BestSingle(responses_, from).table, options_));
    constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
    set.single_error.assign(places_.size(), kNone);
    set.single_error_sigma.assign(places_.size(), kNone);
    for (size_t i = 0; i < places_.size(); ++i) {
      if (std::isnan(places_[i].offset_over_gain)) continue;
      set.single_error[i] = static_cast<float>(single.ErrorAt(ResponseOf(places_[i])));
      set.single_error_sigma[i] = static_cast<float>(single.SigmaAt(places_[i]));
    }
    double squares = 0;
    for (size_t i : members_) {
      Serve(single, places_[i], set.single_error[i]);
      squares += std::pow(set.single_error[i], 2);
    }
    set.single_rms = std::sqrt(squares / static_cast<double>(members_.size()));
    set.single = single.region;
    return absl::OkStatus();
  }

  // The table's own error takes its part of the tolerance; how much is known once it is designed.
  absl::Status DesignMany(CubeSet& set) const {
    constexpr int kTries = 8;
    double own = set.single.table.certificate.max_relative;
    for (int attempt = 0; attempt < kTries; ++attempt) {
      if (own >= options_.tolerance) break;
      const Cover cover =
          CoverResponses(responses_, options_.tolerance - own, options_.design.u_from);
      EYEBOX_ASSIGN_OR_RETURN(const double worst, Assign(cover, set));
      set.at_least = cover.at_least;
      if (worst <= options_.tolerance) return absl::OkStatus();
      own += worst - options_.tolerance + 1e-6;
    }
    return Rejected(
        "tolerance",
        absl::StrFormat("%.3f %% cannot be kept at every place: a table of %d entries leaves %.3f "
                        "%% by itself, and none serves a place whose fitted delta is negative",
                        100 * options_.tolerance, options_.size,
                        100 * set.single.table.certificate.max_relative),
        "choose more entries, larger places or a larger tolerance");
  }

 private:
  // Each place takes the table that suits it best. Gives the worst error.
  absl::StatusOr<double> Assign(const Cover& cover, CubeSet& set) const {
    std::vector<Finished> finished;
    for (const Response& response : cover.tables) {
      EYEBOX_ASSIGN_OR_RETURN(finished.emplace_back(), Finish(response, options_));
    }
    set.table_of.assign(places_.size(), 0);
    double worst = 0;
    for (size_t i : members_) {
      const Response place = ResponseOf(places_[i]);
      size_t best = 0;
      double smallest = std::numeric_limits<double>::infinity();
      for (size_t k = 0; k < finished.size(); ++k) {
        const double error = finished[k].ErrorAt(place);
        if (error >= smallest) continue;
        smallest = error;
        best = k;
      }
      Serve(finished[best], places_[i], smallest);
      set.table_of[i] = static_cast<int>(best) + 1;
      worst = std::max(worst, smallest);
    }
    set.tables.clear();
    for (Finished& table : finished) set.tables.push_back(std::move(table.region));
    return worst;
  }

  std::span<const PlaceResponse> places_;
  const CubeSetOptions& options_;
  std::vector<size_t> members_;
  std::vector<Response> responses_;  // as members_
};

}  // namespace

absl::StatusOr<CubeSet> DesignCubeSet(std::span<const PlaceResponse> places,
                                      std::span<const uint8_t> in_region,
                                      const CubeSetOptions& options) {
  if (in_region.size() != places.size()) {
    return BadInput("region",
                    absl::StrCat("has ", in_region.size(), " places, the field ", places.size()),
                    "give one flag for each place");
  }
  if (!(options.tolerance > 0 && options.tolerance < 1)) {
    return BadInput("tolerance", absl::StrCat(options.tolerance, " is no share"),
                    "give a relative luminance error such as 0.02");
  }
  const Designer designer(places, in_region, options);
  if (designer.empty()) {
    return Rejected("region", "no place in it has a value", "choose a larger region");
  }
  CubeSet set;
  EYEBOX_RETURN_IF_ERROR(designer.DesignSingle(set));
  EYEBOX_RETURN_IF_ERROR(designer.DesignMany(set));
  return set;
}

}  // namespace eyebox::fit
