// Room for the packets that arrive while the receive thread does not run.
#ifndef EYEBOX_CAPTURE_CAMERA_ARAVIS_SOCKET_BUFFER_H_
#define EYEBOX_CAPTURE_CAMERA_ARAVIS_SOCKET_BUFFER_H_

#include <cstdint>
#include <string>

#include "absl/status/status.h"

namespace eyebox::capture::aravis {

// Gives the UDP socket of this process that is bound to `port` a receive buffer of `bytes`, or as
// much as the kernel grants without privilege. Aravis resizes its socket only when the first packet
// is there already, which costs the first frame.
// Errors: Unavailable (no such socket; the kernel grants less than 4 MiB: says which sysctl).
absl::Status EnlargeSocketBuffer(const std::string& uri, uint16_t port, int bytes);

}  // namespace eyebox::capture::aravis

#endif  // EYEBOX_CAPTURE_CAMERA_ARAVIS_SOCKET_BUFFER_H_
