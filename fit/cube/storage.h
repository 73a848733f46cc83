// What lies on the way from a rendered value to the display beside the table itself: how entries
// are held, what the colour buffers keep, how finely the texture unit interpolates, what the
// framebuffer shows.
#ifndef EYEBOX_FIT_CUBE_STORAGE_H_
#define EYEBOX_FIT_CUBE_STORAGE_H_

#include <string>
#include <string_view>
#include <vector>

#include "absl/status/statusor.h"

namespace eyebox::fit {

struct StorageModel {
  bool half = false;       // entries are held as half floats, rounded to the nearest
  bool r11g11b10 = false;  // colour buffers before and after the table, truncated: 6 mantissa bits
                           // for red and green, 5 for blue
  bool filter8 = false;    // weights of the interpolation are multiples of 1/256, to the nearest
  bool output8 = false;    // the framebuffer holds k / 255, to the nearest

  bool IsExact() const { return *this == StorageModel{}; }
  friend bool operator==(const StorageModel&, const StorageModel&) = default;
};

// "half,filter8"; "exact" if nothing is on.
std::string NameOf(const StorageModel& storage);
// What NameOf gives. Errors: InvalidArgument listing the words.
absl::StatusOr<StorageModel> StorageModelOf(std::string_view names);

// Each model that is on by itself, then all of them if there are several; none if it is exact.
std::vector<StorageModel> ModelsOf(const StorageModel& storage);

// Grey stands for all three where they are alike.
enum class Channel { kGrey, kRed, kGreen, kBlue };
std::string_view NameOf(Channel channel);

// One channel on its way. Every step is the identity where the model has it off.
class StoragePath {
 public:
  StoragePath(const StorageModel& storage, Channel channel)
      : storage_(storage), channel_(channel) {}

  double HeldEntry(double entry) const;
  double Buffered(double linear) const;  // into and out of a colour buffer
  double Weight(double weight) const;
  double Shown(double drive) const;  // of [0, 1]

  // The smallest and the largest number whose Buffered() or Shown() is not below or not above the
  // argument; infinite stays infinite.
  double LeastBufferedFrom(double linear) const;
  double MostBufferedTo(double linear) const;
  double LeastShownFrom(double drive) const;
  double MostShownTo(double drive) const;

  // The next number above `linear`, at least 0, that a colour buffer holds. Only with r11g11b10.
  double NextBuffered(double linear) const;

 private:
  StorageModel storage_;
  Channel channel_;
};

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_CUBE_STORAGE_H_
