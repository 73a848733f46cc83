// What a client asks the catalogue for, and where its next page begins.
#ifndef EYEBOX_SERVICE_SERVER_CATALOGUE_QUERY_H_
#define EYEBOX_SERVICE_SERVER_CATALOGUE_QUERY_H_

#include <cstdint>
#include <optional>
#include <string>

#include "absl/status/statusor.h"
#include "eyebox/v1/recording_service.pb.h"
#include "service/server/catalogue/filter.h"

namespace eyebox::service {

// Where a recording stands in either order.
struct CataloguePlace {
  int64_t start_ns = 0;  // CLOCK_REALTIME; 0 where it is not known
  std::string name;      // recordings/R
};

struct CatalogueQuery {
  Filter filter;
  bool by_start_time = false;  // by name otherwise, and among those of one time
  bool descending = false;
  int page_size = 0;
  std::optional<CataloguePlace> after;  // the last of the page before

  uint64_t question = 0;  // checksum of filter and order: a token of another question is refused
};

// Errors: InvalidArgument with the field: page_size, page_token, filter or order_by.
absl::StatusOr<CatalogueQuery> QueryOf(const v1::ListRecordingsRequest& request);

// The page_token of the page that begins behind `last`.
std::string TokenBehind(const CataloguePlace& last, const CatalogueQuery& query);

CataloguePlace PlaceOf(const v1::RecordingEntry& entry);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_SERVER_CATALOGUE_QUERY_H_
