#include "fit/cube/response_cover.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace eyebox::fit {
namespace {

constexpr int kPoints = 17;
constexpr int kSteps = 26;
constexpr double kGolden = 0.6180339887498949;
constexpr double kGammaResolution = 1e-4;

// Golden section; `cost` falls and then rises.
template <typename Cost>
double GoldenMinimum(double low, double high, const Cost& cost) {
  if (high - low <= 0) return low;
  double left = high - kGolden * (high - low);
  double right = low + kGolden * (high - low);
  double left_cost = cost(left);
  double right_cost = cost(right);
  for (int i = 0; i < kSteps; ++i) {
    if (left_cost < right_cost) {
      high = right;
      right = left;
      right_cost = left_cost;
      left = high - kGolden * (high - low);
      left_cost = cost(left);
    } else {
      low = left;
      left = right;
      left_cost = right_cost;
      right = low + kGolden * (high - low);
      right_cost = cost(right);
    }
  }
  return (low + high) / 2;
}

double Departure(const Response& table, const Response& place, double x_from) {
  const std::vector<double> xs = RangeAbove(x_from, table.offset, kPoints);
  return DepartureAt(place, xs, IdealDrives(table, xs));
}

// Of each exponent, the places with the least and the most offset: the others depart less.
std::vector<Response> Extremes(std::span<const Response> places) {
  std::map<long, std::pair<Response, Response>> by_gamma;
  for (const Response& place : places) {
    const long key = std::lround(place.gamma / kGammaResolution);
    auto [found, is_new] = by_gamma.try_emplace(key, place, place);
    if (place.offset < found->second.first.offset) found->second.first = place;
    if (place.offset > found->second.second.offset) found->second.second = place;
  }
  std::vector<Response> extremes;
  for (const auto& [key, pair] : by_gamma) {
    extremes.push_back(pair.first);
    if (pair.second.offset > pair.first.offset) extremes.push_back(pair.second);
  }
  return extremes;
}

bool HaveOneGamma(std::span<const Response> places) {
  const auto [least, most] = std::ranges::minmax_element(places, {}, &Response::gamma);
  return most->gamma - least->gamma < kGammaResolution;
}

// From the darkest offset upwards, each table reaches as far as it can: no other way needs fewer.
Cover CoverLine(std::vector<Response> places, double tolerance, double x_from) {
  std::ranges::sort(places, {}, &Response::offset);
  Cover cover;
  size_t first = 0;
  while (first < places.size()) {
    size_t reached = first;
    size_t beyond = places.size();
    while (beyond - reached > 1) {
      const size_t middle = reached + (beyond - reached) / 2;
      const std::array<Response, 2> ends = {places[first], places[middle]};
      (BestSingle(ends, x_from).departure <= tolerance ? reached : beyond) = middle;
    }
    const std::array<Response, 2> ends = {places[first], places[reached]};
    cover.tables.push_back(BestSingle(ends, x_from).table);
    first = reached + 1;
  }
  cover.at_least = cover.tables.size();
  return cover;
}

// Places of which no two can share a table.
size_t Packing(std::span<const Response> places, double tolerance, double x_from) {
  std::vector<Response> apart;
  for (const Response& place : places) {
    const bool shares = std::ranges::any_of(apart, [&](const Response& other) {
      const std::array<Response, 2> pair = {place, other};
      return BestSingle(pair, x_from).departure <= tolerance;
    });
    if (!shares) apart.push_back(place);
  }
  return apart.size();
}

// Places in cells of a grid, so that a megapixel costs no more than a few hundred places; each cell
// stands for its corners that occur.
std::vector<Response> Thinned(std::span<const Response> places) {
  constexpr int kCells = 16;
  const auto [least, most] = std::ranges::minmax_element(places, {}, &Response::offset);
  const double width = std::max((most->offset - least->offset) / kCells, 1e-12);
  std::map<std::pair<long, long>, std::vector<Response>> cells;
  for (const Response& place : places) {
    cells[{std::lround(place.gamma / kGammaResolution),
           static_cast<long>((place.offset - least->offset) / width)}]
        .push_back(place);
  }
  std::vector<Response> thinned;
  for (const auto& [key, members] : cells) {
    for (const Response& extreme : Extremes(members)) thinned.push_back(extreme);
  }
  return thinned;
}

Cover CoverPlane(std::span<const Response> all, double tolerance, double x_from) {
  constexpr int kGrid = 20;
  std::vector<Response> places = Thinned(all);
  const auto [dark, bright] = std::ranges::minmax_element(places, {}, &Response::offset);
  const auto [flat, steep] = std::ranges::minmax_element(places, {}, &Response::gamma);
  std::vector<Response> candidates(places);
  for (int i = 0; i <= kGrid; ++i) {
    for (int k = 0; k <= kGrid; ++k) {
      candidates.push_back({std::lerp(dark->offset, bright->offset, static_cast<double>(i) / kGrid),
                            std::lerp(flat->gamma, steep->gamma, static_cast<double>(k) / kGrid)});
    }
  }
  Cover cover;
  cover.at_least = Packing(places, tolerance, x_from);
  while (!places.empty()) {
    std::vector<Response> covered;
    Response chosen;
    for (const Response& candidate : candidates) {
      std::vector<Response> within;
      for (const Response& place : places) {
        if (Departure(candidate, place, x_from) <= tolerance) within.push_back(place);
      }
      if (within.size() <= covered.size()) continue;
      covered = within;
      chosen = candidate;
    }
    // Only places whose fit is below zero are out of reach of every table.
    if (covered.empty()) break;
    const BestResponse best = BestSingle(covered, x_from);
    cover.tables.push_back(best.departure <= tolerance ? best.table : chosen);
    const Response table = cover.tables.back();
    std::erase_if(places, [&](const Response& place) {
      return Departure(table, place, x_from) <= tolerance;
    });
  }
  if (cover.tables.empty()) cover.tables.push_back(BestSingle(places, x_from).table);
  return cover;
}

}  // namespace

std::vector<double> RangeAbove(double from, double table_offset, int points) {
  const double offset = std::max(table_offset, 0.0);
  const double lowest = std::min(std::max(from, offset / (1 + offset)), 0.999);
  std::vector<double> xs;
  for (int i = 0; i < points; ++i) {
    xs.push_back(std::pow(lowest, 1 - static_cast<double>(i) / (points - 1)));
  }
  return xs;
}

std::vector<double> IdealDrives(const Response& table, std::span<const double> xs) {
  const double offset = std::max(table.offset, 0.0);
  std::vector<double> drives;
  for (double x : xs) {
    drives.push_back(std::pow(std::max((1 + offset) * x - offset, 0.0), 1 / table.gamma));
  }
  return drives;
}

double DepartureAt(const Response& place, std::span<const double> xs,
                   std::span<const double> drives) {
  double least = std::numeric_limits<double>::infinity();
  double most = -least;
  for (size_t i = 0; i < xs.size(); ++i) {
    const double ratio = (std::pow(drives[i], place.gamma) + place.offset) / xs[i];
    least = std::min(least, ratio);
    most = std::max(most, ratio);
  }
  // A place whose fit goes below zero is as wrong as can be.
  return least > 0 ? (most - least) / (most + least) : 1;
}

BestResponse BestSingle(std::span<const Response> places, double x_from) {
  const std::vector<Response> extremes = Extremes(places);
  const auto worst = [&](const Response& table) {
    double departure = 0;
    for (const Response& place : extremes) {
      departure = std::max(departure, Departure(table, place, x_from));
    }
    return departure;
  };
  const auto offsets = std::ranges::minmax_element(extremes, {}, &Response::offset);
  const auto gammas = std::ranges::minmax_element(extremes, {}, &Response::gamma);
  const double darkest = std::max(offsets.min->offset, 0.0);
  const double brightest = std::max(offsets.max->offset, 0.0);
  const auto offset_for = [&](double gamma) {
    return GoldenMinimum(darkest, brightest, [&](double offset) { return worst({offset, gamma}); });
  };
  const double gamma = GoldenMinimum(gammas.min->gamma, gammas.max->gamma, [&](double each) {
    return worst({offset_for(each), each});
  });
  const Response table = {offset_for(gamma), gamma};
  return {table, worst(table)};
}

Cover CoverResponses(std::span<const Response> places, double tolerance, double x_from) {
  if (HaveOneGamma(places)) {
    return CoverLine({places.begin(), places.end()}, tolerance, x_from);
  }
  return CoverPlane(places, tolerance, x_from);
}

}  // namespace eyebox::fit
