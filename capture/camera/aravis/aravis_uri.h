// What an aravis: URI says: which camera, and what of its state belongs to the rig rather than to
// a capture.
#ifndef EYEBOX_CAPTURE_CAMERA_ARAVIS_ARAVIS_URI_H_
#define EYEBOX_CAPTURE_CAMERA_ARAVIS_ARAVIS_URI_H_

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "absl/status/statusor.h"
#include "capture/base/image.h"
#include "capture/base/pixel_format.h"

namespace eyebox::capture::aravis {

// Part of the sensor that is read out.
struct Region {
  int x_px = 0;
  int y_px = 0;
  ImageSize size;
  friend bool operator==(const Region&, const Region&) = default;
};

struct AravisOptions {
  std::string uri;
  std::string id;     // as Aravis lists it, an IP address or a serial number; empty with `fake`
  bool fake = false;  // Aravis' camera within this process
  std::optional<PixelFormat> pixel_format;  // empty: the deepest monochrome one, else mosaic
  std::optional<Region> region;             // empty: the whole sensor
  int buffers = 0;                          // 0: as many as fit 256 MiB, 8 to 128
  int packet_size_bytes = 0;                // 0: Aravis tries what the network carries
  int64_t packet_delay_ns = 0;
  int socket_buffer_mib = 32;
  bool packet_socket = false;  // as root on loopback a packet socket delivers nothing
  double fake_rate_hz = 1000;  // of the fake camera: a trigger waits for its next tick
};

// "aravis:ID" or "aravis:fake", options behind it like "?pixel_format=Mono12p&region=512x512+8+16".
// The options are pixel_format, region (WxH+X+Y), buffers, packet_size, packet_delay_ns,
// socket_buffer_mib (4 to 32), packet_socket (0 or 1), and fake_rate_hz.
// Errors: InvalidArgument (names the option).
absl::StatusOr<AravisOptions> ParseAravisUri(std::string_view uri);

}  // namespace eyebox::capture::aravis

#endif  // EYEBOX_CAPTURE_CAMERA_ARAVIS_ARAVIS_URI_H_
