// `eyebox tradeoff`: the measured table as a message and as files.
#ifndef EYEBOX_SERVICE_PLANNER_TRADEOFF_RESULT_H_
#define EYEBOX_SERVICE_PLANNER_TRADEOFF_RESULT_H_

#include <filesystem>
#include <string>

#include "absl/status/statusor.h"
#include "capture/camera/rig.h"
#include "eyebox/v1/tradeoff.pb.h"
#include "service/planner/tradeoff.h"

namespace eyebox::service {

struct TradeoffRequest {
  capture::RigConfig rig;  // a simulated one
  // Instead of it: half of a recording's frames are measured with, against the other half.
  std::filesystem::path recording = {};
  std::string recording_name = {};  // in the result; empty: the name of its folder
  std::filesystem::path out;  // folder of tradeoff.json, .csv and .svg; empty: none are written
  TradeoffOptions options;
};

// Errors: InvalidArgument (a rig that is not simulated: its truth is not known); those of
// RecordedFrames::Read and of MeasureTradeoff; the errno of the disk.
absl::StatusOr<v1::TradeoffResult> RunTradeoff(const TradeoffRequest& request,
                                               const Watcher& watcher);

v1::TradeoffResult ToProto(const Tradeoff& tradeoff, const TradeoffOptions& options,
                           const std::string& source);

// A header and one line a setting; times in s, errors relative.
std::string ToCsv(const v1::TradeoffResult& result);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_PLANNER_TRADEOFF_RESULT_H_
