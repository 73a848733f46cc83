#include "service/preflight/read_back.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "absl/strings/str_format.h"

namespace eyebox::service {
namespace {

// The first difference that is met is the one told.
class Comparison {
 public:
  explicit Comparison(const ReadBackOptions& options) : options_(options) {}

  void Add(const ReadBack& pair) {
    const capture::CameraSettings& asked = pair.asked;
    const capture::CameraSettings& reported = pair.reported;
    const double deviation = std::abs(reported.exposure_s / asked.exposure_s - 1);
    // Written so that a NaN differs.
    if (!(deviation <= largest_deviation_)) largest_deviation_ = deviation;
    Hold(deviation <= options_.exposure_tolerance, "exposure_s", asked.exposure_s,
         reported.exposure_s);
    Hold(std::abs(reported.gain_db - asked.gain_db) <= options_.gain_tolerance_db, "gain_db",
         asked.gain_db, reported.gain_db);
    Hold(reported.trigger == asked.trigger && reported.trigger_line == asked.trigger_line,
         "trigger", static_cast<double>(asked.trigger), static_cast<double>(reported.trigger));
    if (!asked.black_level) return;
    const double level = reported.black_level.value_or(NAN);
    Hold(level == *asked.black_level, "black_level", *asked.black_level, level);
  }

  int settings() const { return settings_; }
  int different() const { return different_; }
  double largest_deviation() const { return largest_deviation_; }
  const std::string& first() const { return first_; }

 private:
  void Hold(bool same, const char* name, double asked, double reported) {
    ++settings_;
    if (same) return;
    if (different_++ == 0) {
      first_ = absl::StrFormat("%s was set to %g and reads back %g", name, asked, reported);
    }
  }

  const ReadBackOptions options_;
  int settings_ = 0;
  int different_ = 0;
  double largest_deviation_ = 0;
  std::string first_;
};

}  // namespace

Check CheckReadBack(std::span<const ReadBack> read_backs, const ReadBackOptions& options) {
  Check check = {.name = "read_back", .wanted = "every setting reads back as asked"};
  Comparison comparison(options);
  for (const ReadBack& pair : read_backs) comparison.Add(pair);
  if (comparison.settings() == 0) {
    return std::move(check).Failed("no setting was read back", "configure the camera first");
  }
  check.measured = Figure{"differences", static_cast<double>(comparison.different()), 0, "1"};
  check.figures = {{"settings", static_cast<double>(comparison.settings()), 0, "1"},
                   {"largest_exposure_deviation", comparison.largest_deviation(), 0, "1"}};
  if (comparison.different() == 0) return check;
  return std::move(check).Failed(
      comparison.first(),
      "ask for what the camera can hold, close other programs that use it, and check that no mode "
      "(auto, HDR, binning) overrides the setting");
}

}  // namespace eyebox::service
