#include "service/cli/plan_options.h"

namespace eyebox::service::cli {

std::vector<CLI::Option*> BindPlan(CLI::App& command, capture::PlanOptions& plan) {
  std::vector<CLI::Option*> options = {
      command.add_option("--levels", plan.levels, "Grey levels, 0 and 1 included")
          ->check(CLI::Range(2, 4096)),
      command
          .add_option("--exposures", plan.exposures_s, "Exposure times in s, ascending, by comma")
          ->delimiter(','),
      command.add_option("--repeats", plan.repeats, "Frames per level and exposure"),
      command.add_option("--dark-repeats", plan.dark_repeats, "Dark frames per exposure"),
      command.add_option("--dark-every", plan.dark_every,
                         "Levels between two series of darks, for a camera that warms up; 0: darks "
                         "at the beginning alone"),
      command.add_option("--flat-repeats", plan.flat_repeats,
                         "Flat frames per exposure; 0: no flats"),
      command.add_option("--reference-every", plan.reference_every,
                         "Levels between two looks at the reference patch; 0: none"),
      command.add_option("--reference-drive", plan.reference_drive, "Drive of the reference patch"),
      command
          .add_option(
              "--disks", plan.disk_diameters_deg,
              "Diameters in deg, by comma, of bright disks that show scatter (series glare)")
          ->delimiter(','),
      command
          .add_option("--black-disks", plan.black_disk_diameters_deg,
                      "Likewise of black disks on the bright field")
          ->delimiter(','),
      command
          .add_option("--checkerboards", plan.checkerboard_squares_deg,
                      "Sides in deg, by comma, of the squares of checkerboards, for contrast")
          ->delimiter(','),
      command.add_option("--disk-repeats", plan.disk_repeats,
                         "Frames per disk or board and exposure")};
  for (CLI::Option* option : options) option->capture_default_str();
  return options;
}

}  // namespace eyebox::service::cli
