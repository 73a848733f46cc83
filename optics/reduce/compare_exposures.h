// Whether twice the time gives twice the signal.
#ifndef EYEBOX_OPTICS_REDUCE_COMPARE_EXPOSURES_H_
#define EYEBOX_OPTICS_REDUCE_COMPARE_EXPOSURES_H_

#include "capture/base/image.h"
#include "optics/reduce/bracket_report.h"
#include "optics/reduce/measured_image.h"

namespace eyebox::optics {

// Ratio of the two rates over the pixels valid in both: sum(w longer) / sum(w shorter), with
// w = expected rate / (sum of variances), which minimises its variance for one common ratio and
// lets pixels without signal not count. Images in DN/s, same size.
ExposurePairCheck CompareExposures(const MeasuredImage& shorter, double shorter_s,
                                   const MeasuredImage& longer, double longer_s,
                                   const Image<float>& expected_rate_dn_s);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_REDUCE_COMPARE_EXPOSURES_H_
