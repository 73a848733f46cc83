// The text of a SELECT for a query. Nothing that a client sends is part of it: values are bound.
#ifndef EYEBOX_SERVICE_SERVER_CATALOGUE_SELECT_H_
#define EYEBOX_SERVICE_SERVER_CATALOGUE_SELECT_H_

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "service/server/catalogue/query.h"

namespace eyebox::service {

// Stands before and behind every name in a column that holds several.
inline constexpr char kNameFence = '\x1f';

struct BoundSql {
  std::string where_and_order;                             // parameters are ?1, ?2, ...
  std::vector<std::variant<int64_t, std::string>> values;  // of the parameters
};

// What follows the FROM of a SELECT that gives query.page_size + 1 rows at most.
BoundSql SqlOf(const CatalogueQuery& query);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_SERVER_CATALOGUE_SELECT_H_
