// Where the variance of a merged image comes from.
#ifndef EYEBOX_OPTICS_REDUCE_VARIANCE_BUDGET_H_
#define EYEBOX_OPTICS_REDUCE_VARIANCE_BUDGET_H_

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "capture/base/image.h"
#include "optics/reduce/bracket_report.h"
#include "optics/reduce/expected_rate.h"
#include "optics/reduce/linearise.h"
#include "optics/reduce/measured_image.h"
#include "optics/reduce/measured_row.h"
#include "optics/sensor/noise_model.h"

namespace eyebox::optics {

// Follows an inverse-variance merge on evenly sampled pixels (65536 at most). With w = 1/v, a term
// T of the exposures' variances v makes up sum(w^2 T) / sum(w) of the merged variance 1/sum(w).
class VarianceBudgetMeter {
 public:
  VarianceBudgetMeter(const NoiseModel& noise, const std::optional<LinearityCurve>& linearity,
                      ImageSize size);

  // A whole exposure and some pixels of its rate in DN/s as they enter the merge, with what is
  // expected of them; `first` is the first one's place in the image. Disjoint parts may be added at
  // the same time, the exposures of one part in one order.
  void Add(const Exposure& exposure, const ConstMeasuredRow& rate,
           std::span<const float> expected_rate_dn_s, size_t first = 0);

  // Each share to 1e-14. All zero if no sampled pixel is valid.
  VarianceBudget Mean() const;

 private:
  struct PixelSums {
    double weight = 0;
    VarianceBudget terms;  // sums of w^2 T; flat stays 0
  };

  NoiseModel noise_;
  std::optional<LinearityCurve> linearity_;
  size_t stride_;
  std::vector<PixelSums> pixels_;
};

// The budget once `share` (0 to 1) of the variance comes from another term; the rest shrinks.
VarianceBudget WithShare(const VarianceBudget& budget, double VarianceBudget::*term, double share);

// The budget of `image`, whose scale has that relative standard uncertainty.
VarianceBudget WithScale(const VarianceBudget& budget, const MeasuredImage& image,
                         double relative_sigma);

// The budget of `ratio`, an image that was divided by the flat `response`, from that of the image.
VarianceBudget WithFlat(const VarianceBudget& budget, const MeasuredImage& ratio,
                        const MeasuredImage& response);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_REDUCE_VARIANCE_BUDGET_H_
