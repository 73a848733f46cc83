// A libhdf5 identifier that closes itself, and the lock under which libhdf5 is called.
#ifndef EYEBOX_CAPTURE_RECORDING_HDF5_HANDLE_H_
#define EYEBOX_CAPTURE_RECORDING_HDF5_HANDLE_H_

#include <cstdint>
#include <mutex>
#include <string>
#include <utility>

namespace eyebox::capture {

// hid_t and its closing function, without the header of libhdf5.
class Hdf5Handle {
 public:
  using Closer = int (*)(int64_t);
  Hdf5Handle(int64_t id, Closer close) : id_(id), close_(close) {}
  Hdf5Handle(Hdf5Handle&& other) noexcept
      : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Hdf5Handle& operator=(Hdf5Handle&&) = delete;
  ~Hdf5Handle() { Close(); }

  // False if libhdf5 could not write what it still held.
  bool Close() { return id_ < 0 || close_(std::exchange(id_, -1)) >= 0; }
  bool ok() const { return id_ >= 0; }
  int64_t id() const { return id_; }

 private:
  int64_t id_;
  Closer close_;
};

// Held while libhdf5 is called; also keeps it from printing.
class Hdf5Lock {
 public:
  Hdf5Lock();

 private:
  std::lock_guard<std::mutex> lock_;
};

// What libhdf5 last complained of in this thread, in one line.
std::string Hdf5Complaint();

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_RECORDING_HDF5_HANDLE_H_
