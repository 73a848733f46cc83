#include "capture/base/status.h"

#include <gtest/gtest.h>

#include <cerrno>

namespace eyebox {
namespace {

TEST(Status, SaysWhereWhatAndWhatToDo) {
  EXPECT_EQ(BadInput("rig.textproto:3 seed", "is -1", "give 0 or more").message(),
            "rig.textproto:3 seed: is -1; give 0 or more");
  EXPECT_EQ(Complaint("a", "b", ""), "a: b");
}

TEST(Status, DecidesTheExitCode) {
  EXPECT_EQ(ExitCodeFor(absl::OkStatus()), 0);
  EXPECT_EQ(ExitCodeFor(BadInput("a", "b", "c")), 3);
  EXPECT_EQ(ExitCodeFor(Missing("a", "b", "c")), 3);
  EXPECT_EQ(ExitCodeFor(Corrupt("a", "b", "c")), 3);
  EXPECT_EQ(ExitCodeFor(DeviceFailed("a", "b", "c")), 4);
  EXPECT_EQ(ExitCodeFor(absl::DeadlineExceededError("a")), 4);
  EXPECT_EQ(ExitCodeFor(Rejected("a", "b", "c")), 5);
}

TEST(Status, OfTheSystemKeepsItsMeaning) {
  EXPECT_TRUE(absl::IsNotFound(SystemFailed("a", ENOENT, "b")));
  EXPECT_TRUE(absl::IsResourceExhausted(SystemFailed("a", ENOSPC, "b")));
  EXPECT_EQ(SystemFailed("a", ENOENT, "b").message(), "a: No such file or directory; b");
}

absl::StatusOr<int> Half(int number) {
  if (number % 2 != 0) return BadInput("number", "is odd", "give an even one");
  return number / 2;
}

absl::StatusOr<int> Quarter(int number) {
  EYEBOX_ASSIGN_OR_RETURN(const int half, Half(number));
  EYEBOX_RETURN_IF_ERROR(Half(half).status());
  return half / 2;
}

TEST(Status, MacrosPassTheFirstErrorOn) {
  EXPECT_EQ(Quarter(8).value(), 2);
  EXPECT_TRUE(absl::IsInvalidArgument(Quarter(7).status()));
  EXPECT_TRUE(absl::IsInvalidArgument(Quarter(6).status()));
}

}  // namespace
}  // namespace eyebox
