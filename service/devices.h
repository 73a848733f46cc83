// What this machine has to measure with.
#ifndef EYEBOX_SERVICE_DEVICES_H_
#define EYEBOX_SERVICE_DEVICES_H_

#include <filesystem>

#include "eyebox/v1/capture.pb.h"

namespace eyebox::service {

// Where to look; tests look elsewhere.
struct DevicePlaces {
  std::filesystem::path nodes = "/dev";
  std::filesystem::path iio = "/sys/bus/iio/devices";
  bool ask_network = true;  // for GigE Vision cameras; takes about a second
};

// Cameras, photodiodes and triggers of every scheme. Nothing is written to a device, and none is
// kept open. Where an IIO device or a serial port has a photodiode on it, nobody can tell.
v1::DevicesResult ListDevices(const DevicePlaces& places = {});

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_DEVICES_H_
