#include "capture/recording/hdf5_handle.h"

#include <hdf5.h>

namespace eyebox::capture {
namespace {

std::mutex& Mutex() {
  static std::mutex mutex;
  return mutex;
}

herr_t KeepInnermost(unsigned, const H5E_error2_t* error, void* text) {
  if (error->desc) *static_cast<std::string*>(text) = error->desc;
  return 0;
}

}  // namespace

// Every file is closed by its owner. One that could not be, because its disk refused, stays half
// open, and libhdf5 would crash over it when the process ends.
Hdf5Lock::Hdf5Lock() : lock_(Mutex()) {
  static const herr_t no_cleanup_at_exit = H5dont_atexit();
  static_cast<void>(no_cleanup_at_exit);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

std::string Hdf5Complaint() {
  std::string text;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_DOWNWARD, KeepInnermost, &text);
  return text.empty() ? "libhdf5 gives no reason" : text;
}

}  // namespace eyebox::capture
