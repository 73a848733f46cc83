// Fits the colour of a display to a series of stimuli, and says whether colour can be promised.
#ifndef EYEBOX_FIT_COLOR_FIT_COLOUR_H_
#define EYEBOX_FIT_COLOR_FIT_COLOUR_H_

#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "fit/base/parameter.h"
#include "fit/color/additivity.h"
#include "fit/color/colour_model.h"
#include "fit/color/colour_series.h"

namespace eyebox::fit {

// What must hold for colour to be promised.
struct ColourOptions {
  std::optional<ColourModelKind> model;  // all are tried unless given
  // Readings are weighted by 1 / max(reading, floor * largest)^2, and errors are figured over
  // components above it.
  double floor = 0.01;
  Xyz largest_left_out_error = {0.03, 0.02, 0.03};  // rms relative, in X, Y, Z
  double additivity_tolerance = 0.01;               // relative
  double constancy_tolerance = 0.01;                // u'v'
  // Errors: InvalidArgument naming the field.
  absl::Status Validate() const;
};

struct FittedColour {
  ColourReading reading;
  Xyz fitted = {};
  Xyz relative_residual = {};  // (measured - fitted) / max(measured, floor)
  Xyz left_out_error = {};  // (predicted without this stimulus - measured) / max(measured, floor)
  std::array<bool, 3> counts = {};  // X, Y, Z above the floor: in the figures
};

struct ColourFit {
  ColourModel model;
  std::vector<Parameter> parameters;  // named by ParameterNames
  // In their order, row-major; scaled by the scatter of the readings above the floor. A parameter
  // that ended at its bound (the termination says so) keeps the sigma it would have without the
  // bound.
  std::vector<double> covariance;
  std::vector<FittedColour> stimuli;
  // Over components above the floor; 0 if there is none.
  Xyz rms_relative = {};
  Xyz leave_one_out_rms_relative = {};  // each stimulus predicted by a fit without it
  double chi_square = 0;
  int degrees_of_freedom = 0;
  double aicc = 0;
  std::string termination;

  // Root of the mean square of leave_one_out_rms_relative: what models are compared by.
  double LeftOutError() const;
};

// Errors: those of ColourSeries::Validate(); FailedPrecondition (fewer readings than parameters, or
// readings that do not determine them; no convergence).
absl::StatusOr<ColourFit> FitColour(const ColourSeries& series, ColourModelKind kind,
                                    double floor = 0.01);

struct ColourChoice {
  ColourFit best;
  std::vector<ColourFit> tried;
  std::string reason;  // why the best one was taken, in words
  AdditivityTest additivity;
  std::array<ConstancyTest, 3> constancy;
  // Colour may be promised: left-out stimuli are predicted within ColourOptions, channels keep
  // their chromaticity, and either the display is additive or the model holds its interaction.
  bool certified = false;
  std::string verdict;  // why or why not
  // True if a stimulus mixes channels and is no grey. Else how an interaction is shared among the
  // neighbours of a channel is an assumption that no reading tests.
  bool mixtures_measured = false;
};

// The model with the smallest leave-one-out error; one with more parameters only where it is
// clearly better. Errors: those of FitColour, ColourOptions::Validate().
absl::StatusOr<ColourChoice> ChooseColour(const ColourSeries& series,
                                          const ColourOptions& options = {});

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_COLOR_FIT_COLOUR_H_
