// EMVA 1288 descriptor files: which image belongs to which exposure and irradiation.
//
//   # comment
//   v 3.0                      version of the format
//   n 12 640 480               significant bits, width, height
//   b 1000000 15000.5          a bright set: exposure in ns, mean photons per pixel
//   i images\b_0001.png        an image of the set above; paths lie beneath the descriptor's folder
//   d 1000000                  a dark set: exposure in ns
//   i images\d_0001.png
#ifndef EYEBOX_OPTICS_SENSOR_EMVA1288_DESCRIPTOR_H_
#define EYEBOX_OPTICS_SENSOR_EMVA1288_DESCRIPTOR_H_

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/statusor.h"
#include "capture/base/image.h"

namespace eyebox::optics {

struct DescribedImage {
  std::filesystem::path file;  // beneath the descriptor's folder, that folder included
  int line = 0;
};

struct DescribedSet {
  bool dark = false;
  double exposure_ns = 0;
  double photons = 0;  // mean per pixel and exposure, 0 for darks
  int line = 0;
  std::vector<DescribedImage> images;  // two or more
};

struct Emva1288Descriptor {
  std::string version;
  int bits = 0;
  ImageSize size;
  std::vector<DescribedSet> sets;  // in the file's order
};

// Paths may be written with / or \; a decimal comma counts as a point. Strict: an unknown command,
// a second v or n, a set of fewer than two images, two sets of one condition with equally many
// images, an absolute path or one with "..", and a number that is not finite or not above 0 are
// errors. `name` is put before ":line" in messages; `folder` holds the images.
// Errors: InvalidArgument, with line and what to do.
absl::StatusOr<Emva1288Descriptor> ParseEmva1288Descriptor(std::string_view text,
                                                           std::string_view name,
                                                           const std::filesystem::path& folder);

// Errors: also NotFound, PermissionDenied.
absl::StatusOr<Emva1288Descriptor> ReadEmva1288Descriptor(const std::filesystem::path& file);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_SENSOR_EMVA1288_DESCRIPTOR_H_
