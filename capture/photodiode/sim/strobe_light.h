// The light of a display that flashes once a refresh, as a function of time.
#ifndef EYEBOX_CAPTURE_PHOTODIODE_SIM_STROBE_LIGHT_H_
#define EYEBOX_CAPTURE_PHOTODIODE_SIM_STROBE_LIGHT_H_

namespace eyebox::capture {

// Lit from phase_s to phase_s + duty * period_s of every period; 1 while lit, 0 otherwise.
// 0 < duty <= 1; a duty of 1 is a display that does not flash.
struct StrobeLight {
  double period_s = 1.0 / 90;
  double duty = 0.2;
  double phase_s = 0;

  double At(double time_s) const;
  // Seconds of light from begin_s to end_s, exact: what an exposure collects.
  double IntegralS(double begin_s, double end_s) const;
};

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_PHOTODIODE_SIM_STROBE_LIGHT_H_
