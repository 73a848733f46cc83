// The correction of counts for a sensor whose answer is not quite a straight line.
#ifndef EYEBOX_OPTICS_REDUCE_LINEARISE_H_
#define EYEBOX_OPTICS_REDUCE_LINEARISE_H_

#include <cstddef>
#include <span>
#include <vector>

#include "absl/status/statusor.h"
#include "optics/reduce/measured_image.h"
#include "optics/reduce/measured_row.h"

namespace eyebox::optics {

// Counts above the dark -> counts proportional to the light, DN to DN. Strictly rising, straight
// between knots, through 0; unchanged at `reference_dn`, since no ratio of exposures fixes a scale.
struct LinearityCurve {
  std::vector<double> knots_dn;      // measured counts, ascending, the first 0
  std::vector<double> corrected_dn;  // the first 0
  std::vector<double> variance_dn2;  // of corrected_dn; common to all pixels of one count
  double reference_dn = 0;
  double from_dn = 0;  // counts that the data cover; beyond, the nearest relative correction holds
  double to_dn = 0;
  double reduced_chi2 = 0;  // of the pairs; above 1 the variances have been scaled by it
  int pairs = 0;

  struct Corrected {
    double value_dn = 0;
    double slope = 1;         // d corrected / d measured
    double variance_dn2 = 0;  // of the curve
  };
  Corrected At(double measured_dn) const;
  // Largest |corrected / measured - 1| at the knots that the data cover.
  double LargestRelativeCorrection() const;
};

// Mean counts above the dark of the same pixels under constant light, or under light known up to
// a factor: `ratio` is longer over shorter of light times time. Variances are of the means.
struct LinearityPair {
  double shorter_dn = 0;
  double longer_dn = 0;
  double ratio = 0;
  double shorter_variance_dn2 = 0;
  double longer_variance_dn2 = 0;
};

struct ResponsePoint {
  double irradiation = 0;  // any unit
  double signal_dn = 0;    // above the dark
  double variance_dn2 = 0;
};

// Each point with the next of at least 1.5 times its irradiation, and with the last point.
// `points` by rising irradiation; those without light or signal are left out.
std::vector<LinearityPair> PairsOfSeries(std::span<const ResponsePoint> points);

struct LinearityOptions {
  double knots_per_octave = 2;
  // Standard deviation of the second difference of the relative correction from knot to knot: what
  // is believed of a sensor where the data are silent.
  double smoothness = 0.02;
  // Relative standard deviation of a count from light and time that are not quite as stated.
  double relative_floor = 5e-4;
  double reference_dn = 0;  // 0: half of the highest count
};

// Least squares of corrected(longer) = ratio corrected(shorter) over all pairs.
// Errors: FailedPrecondition (fewer than three usable pairs; or the pairs ask for a curve that
// does not rise: light or times were not as stated).
absl::StatusOr<LinearityCurve> EstimateLinearity(std::span<const LinearityPair> pairs,
                                                 const LinearityOptions& options = {});

// Corrects an image of counts above the dark; the variance is that of the count times the slope
// squared plus that of the curve. Errors: InvalidArgument (image not in DN).
absl::StatusOr<MeasuredImage> Linearise(MeasuredImage image_dn, const LinearityCurve& curve);
// The same of some pixels.
void LinearisePixels(const LinearityCurve& curve, const MeasuredRow& counts_dn);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_REDUCE_LINEARISE_H_
