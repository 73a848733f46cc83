// How many of something a client gets at a time.
#ifndef EYEBOX_SERVICE_SERVER_STORE_PAGING_H_
#define EYEBOX_SERVICE_SERVER_STORE_PAGING_H_

#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "service/server/store/names.h"

namespace eyebox::service {

inline constexpr int kDefaultPageSize = 20;
inline constexpr int kMaxPageSize = 100;

// The field page_size, 0 being the default. Errors: InvalidArgument with the field.
inline absl::StatusOr<int> PageSizeOf(int asked) {
  if (asked == 0) return kDefaultPageSize;
  if (asked >= 1 && asked <= kMaxPageSize) return asked;
  return BadField("page_size", absl::StrCat("is ", asked),
                  absl::StrCat("give 1 to ", kMaxPageSize, ", or 0 for the default"));
}

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_SERVER_STORE_PAGING_H_
