// The calls to a capture job that answer at once.
#include "capture/base/status.h"
#include "capture/plan.h"
#include "capture/recording/convert.h"
#include "service/server/handlers/handlers.h"
#include "service/server/handlers/reply.h"
#include "service/server/store/names.h"

namespace eyebox::service {
namespace {

constexpr int kMostLevels = 4096;
constexpr int kMostExposures = 64;
constexpr int kMostDisks = 256;

capture::PlanOptions OptionsOf(const v1::MakePlanRequest& request) {
  capture::PlanOptions options;
  if (request.has_levels()) options.levels = request.levels();
  if (!request.exposures_s().empty()) {
    options.exposures_s = {request.exposures_s().begin(), request.exposures_s().end()};
  }
  if (request.has_repeats()) options.repeats = request.repeats();
  if (request.has_dark_repeats()) options.dark_repeats = request.dark_repeats();
  if (request.has_dark_every()) options.dark_every = request.dark_every();
  if (request.has_flat_repeats()) options.flat_repeats = request.flat_repeats();
  if (request.has_reference_every()) options.reference_every = request.reference_every();
  if (request.has_reference_drive()) options.reference_drive = request.reference_drive();
  options.disk_diameters_deg = {request.disk_diameters_deg().begin(),
                                request.disk_diameters_deg().end()};
  options.black_disk_diameters_deg = {request.black_disk_diameters_deg().begin(),
                                      request.black_disk_diameters_deg().end()};
  options.checkerboard_squares_deg = {request.checkerboard_squares_deg().begin(),
                                      request.checkerboard_squares_deg().end()};
  if (request.has_seed()) options.seed = request.seed();
  return options;
}

absl::StatusOr<v1::CapturePlan> Plan(const v1::MakePlanRequest& request) {
  if (request.levels() > kMostLevels || request.exposures_s_size() > kMostExposures ||
      request.disk_diameters_deg_size() + request.black_disk_diameters_deg_size() +
              request.checkerboard_squares_deg_size() >
          kMostDisks) {
    return BadField("levels", "with exposures and disks, are more than a plan may hold",
                    "ask for at most 4096 levels, 64 exposures, 256 disks and boards");
  }
  EYEBOX_ASSIGN_OR_RETURN(const CapturePlan plan, capture::MakeGreyPlan(OptionsOf(request)));
  return capture::ToProto(plan);
}

absl::StatusOr<v1::Job> Finish(Jobs& jobs, const std::string& name) {
  EYEBOX_ASSIGN_OR_RETURN(const int64_t number, JobNumber("name", name));
  EYEBOX_ASSIGN_OR_RETURN(const auto desk, jobs.DeskOf(number));
  EYEBOX_RETURN_IF_ERROR(desk->Finish());
  return jobs.table().Latest(number);
}

absl::StatusOr<v1::AckShownReply> Acknowledge(Jobs& jobs, const v1::AckShownRequest& request) {
  EYEBOX_ASSIGN_OR_RETURN(const int64_t number, JobNumber("name", request.name()));
  EYEBOX_ASSIGN_OR_RETURN(const auto desk, jobs.DeskOf(number));
  EYEBOX_RETURN_IF_ERROR(desk->Shown(request.step()));
  return v1::AckShownReply();
}

}  // namespace

grpc::ServerUnaryReactor* MakePlan(const HandlerContext& /*context*/,
                                   grpc::CallbackServerContext* call,
                                   const v1::MakePlanRequest* request, v1::CapturePlan* response) {
  grpc::ServerUnaryReactor* reactor = call->DefaultReactor();
  Reply(reactor, Plan(*request), response);
  return reactor;
}

grpc::ServerUnaryReactor* FinishCapture(const HandlerContext& context,
                                        grpc::CallbackServerContext* call,
                                        const v1::FinishCaptureRequest* request,
                                        v1::Job* response) {
  grpc::ServerUnaryReactor* reactor = call->DefaultReactor();
  Reply(reactor, Finish(context.jobs, request->name()), response);
  return reactor;
}

grpc::ServerUnaryReactor* AckShown(const HandlerContext& context, grpc::CallbackServerContext* call,
                                   const v1::AckShownRequest* request,
                                   v1::AckShownReply* response) {
  grpc::ServerUnaryReactor* reactor = call->DefaultReactor();
  Reply(reactor, Acknowledge(context.jobs, *request), response);
  return reactor;
}

}  // namespace eyebox::service
