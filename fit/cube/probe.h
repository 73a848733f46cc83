// Tells from a few patches whether a table reached the display as it was written, and if not, what
// happened to it on the way.
#ifndef EYEBOX_FIT_CUBE_PROBE_H_
#define EYEBOX_FIT_CUBE_PROBE_H_

#include <span>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "fit/base/activation.h"
#include "fit/cube/table_file.h"
#include "optics/render/colour_table.h"

namespace eyebox::fit {

// One thing that may be true of the table in the renderer. Luminance is linear in L1 and L0 of the
// activation; channels weigh as the primaries of Rec. 709, which matters only where they differ.
class ProbeHypothesis {
 public:
  ProbeHypothesis(std::string name, TableTarget target, const Cube3d& held, int read_size,
                  bool has_exponent);

  const std::string& name() const { return name_; }
  // A transfer v^p follows the framebuffer, p unknown.
  bool has_exponent() const { return has_exponent_; }
  double Luminance(const Activation& activation, double u, double exponent = 1) const;
  // Standard deviation that rounding the framebuffer to 8 bits adds.
  double OutputSigma(const Activation& activation, double u) const;

 private:
  std::array<double, 3> Drive(double u) const;

  std::string name_;
  TableTarget target_;
  optics::ColourTable table_;
  int read_size_;  // that the renderer believes in
  bool has_exponent_;
};

// "right table", "sRGB import", "block compression", "colour-managed desktop" and, for kHdrp, whose
// shader scales positions by the project's size and not the texture's, "grading size 16" and so on.
// Errors: InvalidArgument (kPtb: no renderer reads it as a texture).
absl::StatusOr<std::vector<ProbeHypothesis>> ProbeHypotheses(TableTarget target,
                                                             const Cube3d& table);

// Rendered values in (0, 1], ascending, chosen one by one so that the two hypotheses that are
// hardest to tell apart become easiest to; white is always among them. `noise_relative` of a
// reading.
std::vector<double> ChooseProbePatches(std::span<const ProbeHypothesis> hypotheses,
                                       const Activation& activation, int count,
                                       double noise_relative);

// Sum of squares in sigmas by which the expected readings of `truth` miss the best fit of `model`.
double ProbeSeparation(const ProbeHypothesis& truth, const ProbeHypothesis& model,
                       const Activation& activation, std::span<const double> patches,
                       double noise_relative);

struct ProbeReading {
  double u = 0;
  double luminance = 0;
  double sigma = 0;  // standard uncertainty, above 0
};

struct ProbeLikelihood {
  double chi_square = 0;
  double scale = 0;     // measured luminance over expected
  double exponent = 1;  // of the transfer after the framebuffer
  int free_parameters = 0;
  double log_occam = 0;             // at most 0: the price of the free exponent
  double log_likelihood_ratio = 0;  // to the likeliest, log_occam included
  double probability = 0;           // from equal ones before
};

struct ProbeVerdict {
  std::vector<ProbeLikelihood> likelihoods;  // as the hypotheses
  std::string verdict;                       // a name, "undecided" or "none of these"
  std::string reason;
};

// The luminance scale is free, so that relative readings and a drifted display do. Named only if
// its probability is 95 % or more and its residuals are no larger than 1 in 1000 would be by noise.
// Errors: InvalidArgument (a reading that is not positive or has no sigma), FailedPrecondition
// (fewer than 4 readings).
absl::StatusOr<ProbeVerdict> JudgeProbe(std::span<const ProbeHypothesis> hypotheses,
                                        const Activation& activation,
                                        std::span<const ProbeReading> readings);

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_CUBE_PROBE_H_
