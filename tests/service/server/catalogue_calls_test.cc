// Recordings listed through the server.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "eyebox/v1/recording_service.grpc.pb.h"
#include "google/rpc/error_details.pb.h"
#include "google/rpc/status.pb.h"
#include "tests/service/server/server_fixture.h"
#include "tests/service/server/small_recording.h"

namespace eyebox::service {
namespace {

using grpc::StatusCode;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class CatalogueCallsTest : public ServerFixture {
 protected:
  std::filesystem::path Data() const { return folder_.path() / "data"; }

  grpc::Status List(const v1::ListRecordingsRequest& request,
                    v1::ListRecordingsResponse* response) {
    const auto stub = v1::RecordingService::NewStub(channel_);
    CallContext context;
    return stub->ListRecordings(&context, request, response);
  }
  std::vector<std::string> Names(const std::string& filter) {
    v1::ListRecordingsRequest request;
    request.set_filter(filter);
    v1::ListRecordingsResponse response;
    const grpc::Status status = List(request, &response);
    EXPECT_TRUE(status.ok()) << status.error_message();
    std::vector<std::string> names;
    for (const v1::RecordingEntry& entry : response.recordings()) names.push_back(entry.name());
    return names;
  }
};

TEST_F(CatalogueCallsTest, RecordingsOfOthersAppearAndGoWhileTheServerRuns) {
  EXPECT_THAT(Names(""), IsEmpty());
  WriteSmall(Data() / "lab/a", {.rig = "left-eye"});
  WriteSmall(Data() / "lab/b", {.taken = 1});
  EXPECT_THAT(Names(""), ElementsAre("recordings/lab/a", "recordings/lab/b"));
  EXPECT_THAT(Names("rig = left-eye AND state = COMPLETE"), ElementsAre("recordings/lab/a"));
  std::filesystem::remove_all(Data() / "lab/a");
  EXPECT_THAT(Names(""), ElementsAre("recordings/lab/b"));
}

TEST_F(CatalogueCallsTest, PagesGoOnAfterARestartAndALostIndex) {
  for (const char* name : {"a", "b", "c"}) WriteSmall(Data() / name, {});
  v1::ListRecordingsRequest request;
  request.set_page_size(2);
  request.set_order_by("start_time desc");
  v1::ListRecordingsResponse first;
  ASSERT_TRUE(List(request, &first).ok());
  ASSERT_EQ(first.recordings_size(), 2);
  EXPECT_EQ(first.recordings(0).name(), "recordings/c");
  StopServer();
  std::ofstream(folder_.path() / "state/catalogue.sqlite") << "garbage";
  StartServer();
  request.set_page_token(first.next_page_token());
  v1::ListRecordingsResponse second;
  ASSERT_TRUE(List(request, &second).ok());
  ASSERT_EQ(second.recordings_size(), 1);
  EXPECT_EQ(second.recordings(0).name(), "recordings/a");
  EXPECT_EQ(second.next_page_token(), "");
}

TEST_F(CatalogueCallsTest, RefusalCarriesTheFieldAndThePosition) {
  v1::ListRecordingsRequest request;
  request.set_filter("state = COMPLETE OR rig = a");
  v1::ListRecordingsResponse response;
  const grpc::Status status = List(request, &response);
  EXPECT_EQ(status.error_code(), StatusCode::INVALID_ARGUMENT);
  google::rpc::Status details;
  ASSERT_TRUE(details.ParseFromString(status.error_details()));
  google::rpc::BadRequest bad;
  ASSERT_TRUE(details.details(0).UnpackTo(&bad));
  ASSERT_EQ(bad.field_violations_size(), 1);
  EXPECT_EQ(bad.field_violations(0).field(), "filter");
  EXPECT_THAT(bad.field_violations(0).description(), HasSubstr("at character 18, there is 'OR'"));
}

TEST_F(CatalogueCallsTest, OneRecordingIsDescribedAsInTheList) {
  WriteSmall(Data() / "a", {});
  v1::ListRecordingsResponse list;
  ASSERT_TRUE(List({}, &list).ok());
  ASSERT_EQ(list.recordings_size(), 1);
  const auto stub = v1::RecordingService::NewStub(channel_);
  CallContext context;
  v1::GetRecordingRequest request;
  request.set_name("recordings/a");
  v1::RecordingEntry entry;
  ASSERT_TRUE(stub->GetRecording(&context, request, &entry).ok());
  EXPECT_EQ(entry.SerializeAsString(), list.recordings(0).SerializeAsString());
  EXPECT_EQ(entry.state(), v1::RECORDING_STATE_COMPLETE);
}

}  // namespace
}  // namespace eyebox::service
