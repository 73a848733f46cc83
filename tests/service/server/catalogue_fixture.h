// A catalogue of a folder of small recordings.
#ifndef EYEBOX_TESTS_SERVICE_SERVER_CATALOGUE_FIXTURE_H_
#define EYEBOX_TESTS_SERVICE_SERVER_CATALOGUE_FIXTURE_H_

#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

#include "service/server/catalogue/catalogue.h"
#include "tests/service/server/small_recording.h"
#include "tests/support/temporary_folder.h"

namespace eyebox::service {

// Far from the time at which files are touched, in either direction.
constexpr int64_t kFarFutureNs = 9'000'000'000'000'000'000;

class CatalogueFixture : public testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(Data());
    std::filesystem::create_directories(State());
    data_.emplace(*RootFolder::Open(Data()));
    catalogue_.emplace(State(), &*data_, &clock_,
                       [this](const std::string& what) { told_.push_back(what); });
  }

  std::filesystem::path Data() const { return folder_ / "data"; }
  std::filesystem::path State() const { return folder_ / "state"; }
  std::filesystem::path File() const { return State() / "catalogue.sqlite"; }

  v1::ListRecordingsResponse Page(const v1::ListRecordingsRequest& request) {
    const auto page = catalogue_->List(request);
    EXPECT_TRUE(page.ok()) << page.status();
    return page.ok() ? *page : v1::ListRecordingsResponse();
  }
  // Names below the served folder.
  std::vector<std::string> Names(const std::string& filter = "", const std::string& order = "") {
    v1::ListRecordingsRequest request;
    request.set_page_size(100);
    request.set_filter(filter);
    request.set_order_by(order);
    std::vector<std::string> names;
    const v1::ListRecordingsResponse page = Page(request);
    for (const auto& entry : page.recordings()) {
      names.push_back(entry.name().substr(std::string("recordings/").size()));
    }
    return names;
  }
  v1::RecordingEntry Entry(const std::string& name) {
    v1::ListRecordingsRequest request;
    request.set_filter("name = \"recordings/" + name + "\"");
    const auto page = Page(request);
    EXPECT_EQ(page.recordings_size(), 1) << name;
    return page.recordings_size() == 1 ? page.recordings(0) : v1::RecordingEntry();
  }

  TemporaryFolder folder_;
  ManualClock clock_{0, kFarFutureNs};
  std::optional<RootFolder> data_;
  std::vector<std::string> told_;
  std::optional<Catalogue> catalogue_;
};

}  // namespace eyebox::service

#endif  // EYEBOX_TESTS_SERVICE_SERVER_CATALOGUE_FIXTURE_H_
