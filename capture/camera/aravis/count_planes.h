// Memory for unpacked counts, used again and again: fresh pages cost more than unpacking.
#ifndef EYEBOX_CAPTURE_CAMERA_ARAVIS_COUNT_PLANES_H_
#define EYEBOX_CAPTURE_CAMERA_ARAVIS_COUNT_PLANES_H_

#include <cstdint>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace eyebox::capture::aravis {

// Thread-safe. Planes outlive it.
class CountPlanes : public std::enable_shared_from_this<CountPlanes> {
 public:
  // A plane of `pixels` counts, what they are is unspecified. It comes back when its last owner
  // lets it go.
  std::shared_ptr<std::vector<uint16_t>> Take(size_t pixels) {
    std::unique_ptr<std::vector<uint16_t>> plane;
    {
      const std::lock_guard lock(mutex_);
      if (!idle_.empty()) {
        plane = std::move(idle_.back());
        idle_.pop_back();
      }
    }
    if (!plane) plane = std::make_unique<std::vector<uint16_t>>();
    plane->resize(pixels);
    return {plane.release(), [pool = weak_from_this()](std::vector<uint16_t>* returned) {
              std::unique_ptr<std::vector<uint16_t>> owned(returned);
              if (const auto alive = pool.lock()) alive->GiveBack(std::move(owned));
            }};
  }

 private:
  void GiveBack(std::unique_ptr<std::vector<uint16_t>> plane) {
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(plane));
  }

  std::mutex mutex_;
  std::vector<std::unique_ptr<std::vector<uint16_t>>> idle_;
};

}  // namespace eyebox::capture::aravis

#endif  // EYEBOX_CAPTURE_CAMERA_ARAVIS_COUNT_PLANES_H_
