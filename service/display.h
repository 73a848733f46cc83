// How a display answers a drive value, as `eyebox fit --json` printed it.
#ifndef EYEBOX_SERVICE_DISPLAY_H_
#define EYEBOX_SERVICE_DISPLAY_H_

#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "absl/status/statusor.h"
#include "eyebox/v1/results.pb.h"
#include "fit/activation/fit_activation.h"
#include "fit/color/colour_model.h"
#include "optics/render/rgb.h"

namespace eyebox::service {

class Display {
 public:
  // Of a series of greys, or of colours. Errors: NotFound; InvalidArgument naming file and field.
  static absl::StatusOr<Display> Read(const std::filesystem::path& file);

  // Names of what it tells: "luminance"; "x", "y", "z" of a display fitted in colour.
  std::vector<std::string> Quantities() const;
  // One of each, in that order, with the sigma of the fit; none where it does not know: a coloured
  // drive of a display that was measured in grey.
  std::vector<v1::Parameter> Answer(const optics::Rgb& drive) const;

 private:
  struct Colour {
    fit::ColourModel model;
    std::vector<double> covariance;
  };

  std::variant<fit::ActivationFit, Colour> answer_;  // of greys: activation, model, covariance
  std::string unit_;
};

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_DISPLAY_H_
