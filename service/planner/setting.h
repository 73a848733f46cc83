// What may be spent on a measurement, and what a scene asks of it.
#ifndef EYEBOX_SERVICE_PLANNER_SETTING_H_
#define EYEBOX_SERVICE_PLANNER_SETTING_H_

#include <string>
#include <string_view>
#include <vector>

#include "capture/base/capture_spec.h"
#include "fit/activation/fit_activation.h"

namespace eyebox::service {

// One grey level: frames of each exposure that the rig offers, in ascending order; 0: not taken.
struct LevelFrames {
  double drive = 0;
  std::vector<int> frames;
};

// One thing that the scene shows, by itself.
struct ShownFrames {
  DriveRgb drive = {};
  std::vector<int> frames;  // [exposures]
};

// How luminance at other places is told from that at the reference point.
enum class FieldTier {
  kNone,    // it is taken to be the same
  kSmooth,  // a polynomial of the white field; size: its order, 0 to 8
  kBlocks,  // the white field itself, averaged over blocks; size: their side in pixels
};
std::string_view NameOf(FieldTier tier);  // "none", "smooth", "blocks"

// A price and what one gets for it.
struct Setting {
  std::string name;
  // Ascending drive; the last is white, drive 1. Beside `shown`: white alone, for the map; or
  // none, and the last of `shown` makes the map.
  std::vector<LevelFrames> levels;
  // What the scene shows, as it shows it (disks included), ascending luminance: each is read, no
  // activation is fitted and no table made. Empty: levels are measured.
  std::vector<ShownFrames> shown = {};
  fit::ActivationModel model = fit::ActivationModel::kGammaWithCutoff;
  FieldTier tier = FieldTier::kSmooth;
  int tier_size = 4;
  int calibration_frames = 8;  // darks, and flats, of each exposure in use
  int disk_frames = 0;         // of the scene's disk, each exposure of white; 0: glare is left in
  int table_size = 32;         // knots of the HDRP table
  // The levels of red, green and blue, each by itself, instead of grey ones; and white.
  bool primaries = false;
};

// What a scene looks at.
struct Need {
  double radius_deg = 20;  // of the field it uses, about the optical axis
  double u_from = 0.05;    // the darkest value, a fraction of white
  double disk_deg = 0;     // diameter of what is looked at, on black; 0: it fills the field
  std::vector<double> grey_u = {};  // the grey values that are looked at; empty: all from u_from up
  // Coloured things: u of red, green and blue, fractions of white. Empty: grey ones.
  std::vector<DriveRgb> colours = {};
  bool fixed = false;  // none of it ever takes another value, and all of it is of one size
  friend bool operator==(const Need&, const Need&) = default;
};

// What frames and stimuli cost beside the exposures themselves.
struct Costs {
  double stimulus_s = 0.25;      // until a stimulus is shown, steady and answered
  double frame_s = 0.005;        // read-out and storage of a frame
  double compute_s_per_mpx = 0;  // of each frame's pixels, 1e6 at a time; from the pilot
};

// Frames of the image that the map is made of, [exposures].
const std::vector<int>& MapFrames(const Setting& setting);

// Exposures that anything uses, [exposures].
std::vector<bool> ExposuresInUse(const Setting& setting);

// Frames of the scene's disk, [exposures].
std::vector<int> DiskFrames(const Setting& setting);

// Time that the captures of `setting` take, darks and flats included.
double CaptureSeconds(const Setting& setting, const std::vector<double>& exposures_s,
                      const Costs& costs);
// Frames of all its captures.
int FrameCount(const Setting& setting);

// `count` levels, evenly spaced from 0 to 1, each with the same frames.
std::vector<LevelFrames> EvenLevels(int count, const std::vector<int>& frames);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_PLANNER_SETTING_H_
