#include "capture/recording/plan_file.h"

#include <string>
#include <utility>

#include "absl/strings/str_cat.h"
#include "capture/base/file.h"
#include "capture/base/status.h"
#include "capture/recording/convert.h"
#include "capture/recording/text_format.h"

namespace eyebox::capture {
namespace {

constexpr size_t kLargestPlanFile = size_t{16} << 20;

}  // namespace

absl::StatusOr<CapturePlan> ReadPlanFile(const std::filesystem::path& file) {
  EYEBOX_ASSIGN_OR_RETURN(const std::string text, ReadWholeFile(file, kLargestPlanFile));
  v1::CapturePlan message;
  EYEBOX_RETURN_IF_ERROR(ParseText(text, file, message));
  CapturePlan plan;
  for (int i = 0; i < message.captures_size(); ++i) {
    EYEBOX_ASSIGN_OR_RETURN(
        CaptureSpec spec,
        FromProto(message.captures(i), absl::StrCat(file.string(), ", captures[", i, "]")));
    plan.captures.push_back(std::move(spec));
  }
  if (!plan.captures.empty()) return plan;
  return BadInput(file.string(), "holds no capture", "give at least one");
}

absl::Status WritePlanFile(const CapturePlan& plan, const std::filesystem::path& file) {
  return WriteFileAtomically(file, PrintText(ToProto(plan)));
}

}  // namespace eyebox::capture
