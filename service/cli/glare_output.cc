#include "service/cli/glare_output.h"

#include <cstdio>
#include <string>

#include "absl/strings/str_format.h"

namespace eyebox::service::cli {
namespace {

std::string NameOf(const v1::GlareFigure& figure) {
  if (figure.name() == "full_field_contrast") return "full-field contrast";
  if (figure.name() == "checkerboard_contrast") {
    return absl::StrFormat("checkerboard of %.3g deg: contrast", figure.diameter_deg());
  }
  return absl::StrFormat("checkerboard of %.3g deg, the instrument's scatter taken out: contrast",
                         figure.diameter_deg());
}

void PrintBlackSpot(const v1::GlareFigure& figure) {
  std::printf("  black spot of %.3g deg: glare %.3f +- %.2g %% of the field", figure.diameter_deg(),
              100 * figure.value(), 100 * figure.sigma());
  std::printf("; the instrument's floor is %.3f %%%s\n", 100 * figure.floor(),
              figure.instrument_share() > 0 ? "" : " (of noise; its own glare is not known)");
}

}  // namespace

void PrintGlareFigures(const google::protobuf::RepeatedPtrField<v1::GlareFigure>& figures) {
  for (const v1::GlareFigure& figure : figures) {
    if (figure.name() == "black_spot_glare") {
      PrintBlackSpot(figure);
      continue;
    }
    std::printf("  %s %s%.4g +- %.2g : 1; the instrument allows up to %.3g : 1\n",
                NameOf(figure).c_str(), figure.only_lower_bound() ? "at least " : "",
                figure.value(), figure.sigma(), figure.floor());
  }
}

}  // namespace eyebox::service::cli
