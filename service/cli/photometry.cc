#include "service/photometry.h"

#include <cstdio>
#include <filesystem>
#include <map>
#include <string>

#include "absl/strings/str_join.h"
#include "capture/base/file.h"
#include "capture/base/status.h"
#include "service/cli/command.h"
#include "service/cli/terminal.h"
#include "service/result_json.h"

namespace eyebox::service::cli {
namespace {

using Make = absl::StatusOr<v1::PhotometryResult> (*)(const std::filesystem::path&,
                                                      const PhotometryOptions&);

const std::map<std::string, Make> kParts = {{"scale", ScaleOfCamera},
                                            {"photodiode", ScaleOfPhotodiode},
                                            {"mismatch", SpectralMismatchOf},
                                            {"colour", ScaleOfColour}};

struct Options {
  std::string part;
  std::string csv;
  PhotometryOptions photometry;
  std::string out;
  bool json = false;
};

void PrintFigures(const v1::PhotometryResult& result) {
  PrintParameters(result.parameters());
  if (result.has_luminance()) {
    std::printf("  relative sigma %.3g %%; intercept p = %.3g\n",
                100 * result.luminance().relative_sigma(), result.luminance().intercept_p_value());
  }
  if (result.has_photodiode()) {
    std::printf("  %s axes; relative sigma %.3g %%\n", result.photodiode().axes().c_str(),
                100 * result.photodiode().relative_sigma());
  }
  if (result.has_colour()) {
    std::printf(
        "  unit %s; leave-one-out rms %.3g %% of the largest Y with 3 columns, %.3g %% with 4\n",
        result.colour().unit().c_str(), 100 * result.colour().leave_one_out_rms_3(),
        100 * result.colour().leave_one_out_rms_4());
  }
  if (result.has_mismatch()) {
    std::printf("  calibrated with %s\n", result.mismatch().calibration_light().c_str());
  }
}

// What was not accepted is written and printed too, so that one can see why.
absl::Status Run(const Options& options) {
  EYEBOX_ASSIGN_OR_RETURN(const v1::PhotometryResult result,
                          kParts.at(options.part)(options.csv, options.photometry));
  PrintWarnings(result.warnings());
  EYEBOX_ASSIGN_OR_RETURN(const std::string json, ToJson(result));
  if (!options.out.empty()) EYEBOX_RETURN_IF_ERROR(WriteFileAtomically(options.out, json));
  if (options.json) {
    EYEBOX_RETURN_IF_ERROR(PrintJson(result));
  } else {
    PrintFigures(result);
  }
  if (result.accepted()) return absl::OkStatus();
  return Rejected(options.csv, absl::StrJoin(result.reasons(), "; "),
                  "mend it and measure again; the scale will not be used as it is");
}

}  // namespace

void AddPhotometry(CLI::App& app, Work& work) {
  AddCommand<Options>(
      app, work, "photometry", "Learn from known lights what counts mean in cd/m2 and in colour.",
      "eyebox photometry scale flat.csv --meter-sigma 0.02 --out scale.json\n"
      "  eyebox run recording --scale scale.json",
      [](CLI::App& command, Options& options) {
        std::vector<std::string> parts;
        for (const auto& [name, make] : kParts) parts.push_back(name);
        command
            .add_option("part", options.part,
                        "scale (columns luminance_cd_m2,reading_dn_s and luminance_sigma_cd_m2 or "
                        "reading_sigma_dn_s; all at the gain that is measured with), photodiode "
                        "(luminance_cd_m2,counts[,counts_sigma]), mismatch (wavelength_nm,"
                        "responsivity and one a light) or colour (signal_r,signal_g,signal_b,x,y,z"
                        "[,x_sigma,y_sigma,z_sigma])")
            ->required()
            ->check(CLI::IsMember(parts));
        command.add_option("csv", options.csv, "Table of the known lights")->required();
        command.add_option("--meter-sigma", options.photometry.meter_relative_sigma,
                           "Relative standard uncertainty of the meter's calibration");
        command.add_option("--calibration-light", options.photometry.calibration_light,
                           "Column that the detector was calibrated with (default: illuminant A)");
        command.add_option("--wavelength-sigma", options.photometry.wavelength_sigma_nm,
                           "Standard uncertainty of the responsivity's wavelengths, nm");
        command.add_flag("--absolute", options.photometry.absolute,
                         "Tristimulus values of colour are in cd/m2");
        command.add_option("--out", options.out, "Write the result there, as scale.json");
        command.add_flag("--json", options.json, "Print the result as JSON on stdout");
      },
      Run);
}

}  // namespace eyebox::service::cli
