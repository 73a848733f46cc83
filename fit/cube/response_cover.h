// Covering responses of places by as few ideal tables as possible.
#ifndef EYEBOX_FIT_CUBE_RESPONSE_COVER_H_
#define EYEBOX_FIT_CUBE_RESPONSE_COVER_H_

#include <span>
#include <vector>

namespace eyebox::fit {

// What a table is designed for, or a place answers with: L proportional to v^gamma + offset.
struct Response {
  double offset = 0;  // delta / k
  double gamma = 0;
};

// Fractions of white, evenly in log x, from the larger of `from` and the cutoff of `table` to 1.
std::vector<double> RangeAbove(double from, double table_offset, int points);
// The ideal drive value for each x.
std::vector<double> IdealDrives(const Response& table, std::span<const double> xs);
// Departure from proportionality of a place driven so.
double DepartureAt(const Response& place, std::span<const double> xs,
                   std::span<const double> drives);

// The table whose worst departure over `places` is smallest, and that departure.
struct BestResponse {
  Response table;
  double departure = 0;
};
BestResponse BestSingle(std::span<const Response> places, double x_from);

struct Cover {
  std::vector<Response> tables;
  size_t at_least = 0;  // a smaller number is proven not to do
};
// Tables such that each place departs by at most `tolerance` (above 0) from one of them.
Cover CoverResponses(std::span<const Response> places, double tolerance, double x_from);

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_CUBE_RESPONSE_COVER_H_
