// What a client asks the catalogue: a filter, an order and a page token, a line each.
#include <algorithm>
#include <sstream>
#include <string>

#include "service/server/catalogue/index_file.h"
#include "service/server/catalogue/query.h"
#include "service/server/store/names.h"
#include "tests/fuzz/fuzz_input.h"

namespace eyebox::service {
namespace {

IndexFile MakeIndex() {
  auto index = IndexFile::Create(fuzz::ScratchFolder() / "catalogue.sqlite");
  FUZZ_CHECK(index.ok());
  IndexChanges changes;
  for (const char* name : {"recordings/a", "recordings/b/c", "recordings/d"}) {
    IndexRow row;
    row.entry.set_name(name);
    row.entry.set_state(v1::RECORDING_STATE_COMPLETE);
    row.entry.mutable_header()->set_created_real_ns(name[11] * int64_t{1'000'000'000});
    row.entry.add_series("");
    changes.put.push_back(row);
  }
  FUZZ_CHECK(index->Apply(changes).ok());
  return *std::move(index);
}

void CheckRefusal(const absl::Status& status) {
  FUZZ_CHECK(absl::IsInvalidArgument(status));
  FUZZ_CHECK(!FieldOf(status).empty());
  FUZZ_CHECK(status.message().size() < 1000);
  FUZZ_CHECK(std::ranges::all_of(status.message(), [](char c) { return c >= ' ' && c < 127; }));
}

void Ask(const std::string& input) {
  static const IndexFile index = MakeIndex();
  std::istringstream lines(input);
  std::string filter;
  std::string order;
  std::string token;
  std::getline(lines, filter);
  std::getline(lines, order);
  std::getline(lines, token);
  v1::ListRecordingsRequest request;
  request.set_filter(filter);
  request.set_order_by(order);
  request.set_page_token(token);
  const auto query = QueryOf(request);
  if (!query.ok()) return CheckRefusal(query.status());
  // Whatever is understood makes a statement that SQLite takes, and changes nothing.
  const auto some = index.Select(*query);
  FUZZ_CHECK(some.ok() && some->size() <= 3);
  FUZZ_CHECK(index.Stamps()->size() == 3);
  if (some->empty()) return;
  // What comes behind the first is the rest.
  request.set_page_token(TokenBehind(PlaceOf(some->front()), *query));
  const auto rest = index.Select(*QueryOf(request));
  FUZZ_CHECK(rest.ok() && rest->size() == some->size() - 1);
}

}  // namespace
}  // namespace eyebox::service

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  eyebox::service::Ask(std::string(eyebox::fuzz::AsText(data, size)));
  return 0;
}
