#include "capture/camera/aravis/fake_scene.h"

#include <arv.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

namespace eyebox::capture::aravis {
namespace {

constexpr double kReferenceExposureS = 0.01;
constexpr double kReferenceFill = 0.25;

// Rows are copied out of one row that is long enough to start anywhere in the ramp.
template <typename Count>
void DrawRamp(ArvBuffer* buffer, double exposure_s, double full_scale_dn) {
  size_t unused = 0;
  auto* pixels = static_cast<Count*>(const_cast<void*>(arv_buffer_get_data(buffer, &unused)));
  const size_t width = static_cast<size_t>(arv_buffer_get_image_width(buffer));
  const size_t height = static_cast<size_t>(arv_buffer_get_image_height(buffer));
  std::vector<Count> ramp(width + kFakeRampPixels);
  for (size_t i = 0; i < ramp.size(); ++i) {
    ramp[i] = static_cast<Count>(i < kFakeRampPixels
                                     ? FakeRampCount(static_cast<int>(i), exposure_s, full_scale_dn)
                                     : ramp[i - kFakeRampPixels]);
  }
  for (size_t y = 0; y < height; ++y) {
    const size_t start = (y + arv_buffer_get_frame_id(buffer)) % kFakeRampPixels;
    std::memcpy(pixels + y * width, ramp.data() + start, width * sizeof(Count));
  }
}

// Called in the fake camera's own thread, with a buffer as large as the format needs.
void Draw(ArvBuffer* buffer, void*, guint32 exposure_us, guint32, ArvPixelFormat format) {
  const double exposure_s = exposure_us / 1e6;
  switch (format >> 16 & 0xFF) {
    case 8:
      return DrawRamp<uint8_t>(buffer, exposure_s, 255);
    case 16:
      return DrawRamp<uint16_t>(buffer, exposure_s, 65535);
    default:
      return;
  }
}

}  // namespace

double FakeRampCount(int position, double exposure_s, double full_scale_dn) {
  const double relative = 0.5 * (1 + static_cast<double>(position) / (kFakeRampPixels - 1));
  const double count = kReferenceFill * full_scale_dn * relative * exposure_s / kReferenceExposureS;
  return std::min(std::floor(count + 0.5), full_scale_dn);
}

void ShowFakeScene(Device& device, double rate_hz) {
  ArvDevice* native = arv_camera_get_device(static_cast<ArvCamera*>(device.native()));
  ArvFakeCamera* camera = arv_fake_device_get_fake_camera(ARV_FAKE_DEVICE(native));
  arv_fake_camera_set_fill_pattern(camera, Draw, nullptr);
  arv_fake_camera_set_trigger_frequency(camera, rate_hz);
}

}  // namespace eyebox::capture::aravis
