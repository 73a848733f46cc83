#include <hdf5.h>

#include <array>

#include "capture/base/status.h"
#include "capture/recording/capture_file.h"
#include "capture/recording/hdf5_handle.h"

namespace eyebox::capture {
namespace {

using Dimensions = std::array<hsize_t, 3>;

absl::Status Damaged(const std::filesystem::path& file, const std::string& what) {
  return Corrupt(file.string(), what + " (" + Hdf5Complaint() + ")", "restore it from a copy");
}

class OpenFrames final : public PackedFrames {
 public:
  OpenFrames(std::filesystem::path file, const CaptureFileShape& shape, Hdf5Handle hdf5,
             Hdf5Handle frames)
      : file_(std::move(file)), shape_(shape), hdf5_(std::move(hdf5)), frames_(std::move(frames)) {}

  ~OpenFrames() override {
    const Hdf5Lock lock;
    frames_.Close();
    hdf5_.Close();
  }

  absl::Status Read(int frame, std::span<uint16_t> pixels_dn) override {
    const Hdf5Lock lock;
    const Dimensions start = {static_cast<hsize_t>(frame), 0, 0};
    const Dimensions count = {1, static_cast<hsize_t>(shape_.frame_size.height_px),
                              static_cast<hsize_t>(shape_.frame_size.width_px)};
    const Hdf5Handle there(H5Dget_space(frames_.id()), H5Sclose);
    const Hdf5Handle here(H5Screate_simple(3, count.data(), nullptr), H5Sclose);
    if (pixels_dn.size() == shape_.frame_size.PixelCount() &&
        H5Sselect_hyperslab(there.id(), H5S_SELECT_SET, start.data(), nullptr, count.data(),
                            nullptr) >= 0 &&
        H5Dread(frames_.id(), H5T_NATIVE_UINT16, here.id(), there.id(), H5P_DEFAULT,
                pixels_dn.data()) >= 0) {
      return absl::OkStatus();
    }
    return Damaged(file_, "frame " + std::to_string(frame) + " cannot be unpacked");
  }

 private:
  const std::filesystem::path file_;
  const CaptureFileShape shape_;
  Hdf5Handle hdf5_;
  Hdf5Handle frames_;
};

bool HasShape(const Hdf5Handle& frames, const CaptureFileShape& shape) {
  const Hdf5Handle space(H5Dget_space(frames.id()), H5Sclose);
  Dimensions dimensions{};
  return H5Sget_simple_extent_ndims(space.id()) == 3 &&
         H5Sget_simple_extent_dims(space.id(), dimensions.data(), nullptr) == 3 &&
         dimensions == Dimensions{static_cast<hsize_t>(shape.frame_count),
                                  static_cast<hsize_t>(shape.frame_size.height_px),
                                  static_cast<hsize_t>(shape.frame_size.width_px)};
}

}  // namespace

absl::StatusOr<std::unique_ptr<PackedFrames>> PackedFrames::Open(const std::filesystem::path& file,
                                                                 const CaptureFileShape& shape) {
  const Hdf5Lock lock;
  Hdf5Handle hdf5(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (!hdf5.ok()) return Damaged(file, "is no HDF5 file");
  Hdf5Handle frames(H5Dopen2(hdf5.id(), "/frames", H5P_DEFAULT), H5Dclose);
  if (!frames.ok() || !HasShape(frames, shape)) {
    return Damaged(file, "has no /frames of the shape that manifest.log states");
  }
  return std::make_unique<OpenFrames>(file, shape, std::move(hdf5), std::move(frames));
}

}  // namespace eyebox::capture
