// Whatever a client calls things, it is told which field was wrong, and nothing happens.
#include "tests/service/server/hostile_names.h"

#include <gmock/gmock.h>

#include "tests/service/server/server_fixture.h"

namespace eyebox::service {
namespace {

class HostileNamesTest : public ServerFixture {};

TEST_F(HostileNamesTest, EachIsRefusedInEveryFieldAndTheFieldIsNamed) {
  ASSERT_EQ(RunToItsEnd("a").name(), "jobs/000001");
  ASSERT_GE(HostileNames().size(), 40u);
  for (const NameField& field : NameFields()) {
    for (const std::string& name : HostileNames()) {
      SCOPED_TRACE(field.call + " " + field.field + " " + name.substr(0, 80));
      const grpc::Status status = field.send(*stub_, name);
      EXPECT_EQ(status.error_code(), grpc::StatusCode::INVALID_ARGUMENT) << status.error_message();
      EXPECT_EQ(ViolatedField(status), field.field) << status.error_message();
      EXPECT_LT(status.error_message().size(), 1000u) << "no name is sent back whole";
    }
  }
  EXPECT_EQ(work_.begun(), 1) << "no job came of it";
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path() / "data/rec/captures"));
}

}  // namespace
}  // namespace eyebox::service
