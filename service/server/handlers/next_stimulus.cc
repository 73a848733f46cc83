#include <optional>

#include "capture/base/status.h"
#include "service/server/handlers/handlers.h"
#include "service/server/handlers/stimulus_step.h"
#include "service/server/handlers/waiting_call.h"

namespace eyebox::service {

absl::StatusOr<v1::StimulusStep> StepAfter(Jobs& jobs, int64_t number, uint64_t after) {
  v1::StimulusStep step;
  EYEBOX_ASSIGN_OR_RETURN(*step.mutable_job(), jobs.table().Latest(number));
  if (HasEnded(step.job())) return step;
  const auto desk = jobs.DeskOf(number);
  if (absl::IsUnavailable(desk.status())) return step;  // its turn comes
  EYEBOX_RETURN_IF_ERROR(desk.status());
  const auto wanted = (*desk)->ToShow();
  if (absl::IsFailedPrecondition(wanted.status())) return wanted.status();
  if (!wanted.ok() || !*wanted || (*wanted)->step <= after) return step;
  step.set_step((*wanted)->step);
  *step.mutable_capture() = (*wanted)->capture;
  step.set_instruction((*wanted)->instruction);
  return step;
}

grpc::ServerUnaryReactor* NextStimulus(const HandlerContext& context,
                                       const v1::NextStimulusRequest* request,
                                       v1::StimulusStep* response) {
  const auto look = [&jobs = context.jobs, after = request->after_step()](
                        int64_t number,
                        bool over) -> std::optional<absl::StatusOr<v1::StimulusStep>> {
    auto step = StepAfter(jobs, number, after);
    if (over || !step.ok() || step->step() != 0 || HasEnded(step->job())) return step;
    return std::nullopt;
  };
  return WaitingCall<v1::StimulusStep>::Start(context.jobs, request->name(), request->timeout_s(),
                                              look, response);
}

}  // namespace eyebox::service
