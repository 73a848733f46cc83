// Aravis' fake GigE Vision camera as a process of its own, on the loopback interface.
#ifndef EYEBOX_TESTS_CAPTURE_CAMERA_ARAVIS_FAKE_PROCESS_H_
#define EYEBOX_TESTS_CAPTURE_CAMERA_ARAVIS_FAKE_PROCESS_H_

#include <sys/types.h>

#include <memory>
#include <string>

namespace eyebox::capture {

// GigE Vision has one fixed port. Gives this thread, and those it starts, a network of their own,
// so that tests run side by side; where that is not allowed, waits for the lock that every such
// test takes on the host's loopback. Once per process, before anything opens a socket.
// Returns false, and why, where neither works.
bool EnterPrivateNetwork(std::string& why_not);

class FakeGigECamera {
 public:
  // Starts it and waits until it answers; null where the program is not installed or does not.
  static std::unique_ptr<FakeGigECamera> Start(const std::string& serial,
                                               int lost_packets_per_thousand = 0);
  ~FakeGigECamera() { Kill(); }

  // kill -9, and waits for the end. Again does nothing.
  void Kill();
  // "aravis:Aravis-Fake-SERIAL"
  const std::string& uri() const { return uri_; }

 private:
  FakeGigECamera(pid_t process, std::string uri) : process_(process), uri_(std::move(uri)) {}
  pid_t process_;
  const std::string uri_;
};

}  // namespace eyebox::capture

#endif  // EYEBOX_TESTS_CAPTURE_CAMERA_ARAVIS_FAKE_PROCESS_H_
