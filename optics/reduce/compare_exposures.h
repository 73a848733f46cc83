// Whether twice the time gives twice the signal.
#ifndef EYEBOX_OPTICS_REDUCE_COMPARE_EXPOSURES_H_
#define EYEBOX_OPTICS_REDUCE_COMPARE_EXPOSURES_H_

#include <span>

#include "capture/base/image.h"
#include "optics/reduce/bracket_report.h"
#include "optics/reduce/measured_image.h"
#include "optics/reduce/measured_row.h"

namespace eyebox::optics {

// Sums of what the comparison needs, over any number of parts of the images.
struct PairSums {
  double shorter = 0;
  double longer = 0;
  double shorter_variance = 0;
  double longer_variance = 0;
  size_t pixels = 0;
};
void AddPair(const ConstMeasuredRow& shorter, const ConstMeasuredRow& longer,
             std::span<const float> expected_rate_dn_s, PairSums& sums);
ExposurePairCheck CompareExposures(const PairSums& sums, double shorter_s, double longer_s);

// Ratio of the two rates over the pixels valid in both: sum(w longer) / sum(w shorter), with
// w = expected rate / (sum of variances), which minimises its variance for one common ratio and
// lets pixels without signal not count. Images in DN/s, same size.
ExposurePairCheck CompareExposures(const MeasuredImage& shorter, double shorter_s,
                                   const MeasuredImage& longer, double longer_s,
                                   const Image<float>& expected_rate_dn_s);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_REDUCE_COMPARE_EXPOSURES_H_
