// The two fits behind MeasureStrobe(): a sinusoid of unknown frequency, and the folded period.
#ifndef EYEBOX_CAPTURE_PHOTODIODE_STROBE_FIT_H_
#define EYEBOX_CAPTURE_PHOTODIODE_STROBE_FIT_H_

#include <span>
#include <vector>

namespace eyebox::capture {

// One record: times in s about their middle, ascending, and values with mean and trend removed.
struct StrobeRecord {
  std::vector<double> times_s;
  std::vector<double> values;
  double span_s = 0;
  double mean = 0;  // that was removed
};

// value = a cos(2 pi f t) + b sin(2 pi f t).
struct Sinusoid {
  double frequency_hz = 0;
  double cosine = 0;
  double sine = 0;
  double sum_of_squares = 0;  // left after it was subtracted
};

Sinusoid FitAmplitudes(const StrobeRecord& record, double frequency_hz);

// The frequency in [low_hz, high_hz] that leaves least: a grid of 1 / (4 span), then golden section
// about its best point.
Sinusoid FindSinusoid(const StrobeRecord& record, double low_hz, double high_hz);

// Whether so much less is left that noise alone does it with a probability below 1e-6 for
// `trials` frequencies that were tried.
bool IsSignificant(const StrobeRecord& record, double sum_before, double sum_after, double trials);

// The record folded at a period and averaged in `bins` of phase; bins without a sample take the
// mean of their neighbours.
struct FoldedPeriod {
  double low = 0;  // levels of the two plateaus, same unit and zero as the record's values
  double high = 0;
  double duty = 1;
  double residual_rms = 0;  // of the samples about the mean of their bin
  double largest_gap = 0;   // of phase without a sample, periods
};
FoldedPeriod Fold(const StrobeRecord& record, double period_s);

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_PHOTODIODE_STROBE_FIT_H_
