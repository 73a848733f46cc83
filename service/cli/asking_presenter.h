// Where nobody but the experimenter can change what the camera sees: asks, and waits for Enter.
#ifndef EYEBOX_SERVICE_CLI_ASKING_PRESENTER_H_
#define EYEBOX_SERVICE_CLI_ASKING_PRESENTER_H_

#include <cstdio>
#include <functional>
#include <memory>
#include <optional>
#include <utility>

#include "absl/status/status.h"
#include "capture/camera/rig.h"

namespace eyebox::service::cli {

class AskingPresenter final : public capture::StimulusPresenter {
 public:
  // Reads lines from `answers`, which must outlive this and which nobody else reads; asks on
  // stderr. `presenter`, where there is one, presents what was answered. `cancelled` is looked at
  // while an answer is waited for.
  explicit AskingPresenter(std::FILE* answers,
                           std::unique_ptr<capture::StimulusPresenter> presenter = nullptr,
                           std::function<bool()> cancelled = nullptr)
      : answers_(answers), presenter_(std::move(presenter)), cancelled_(std::move(cancelled)) {}

  // What is shown already is not asked for again. Errors: Cancelled (`answers` ended, or
  // `cancelled`), those of `presenter`.
  absl::Status Present(const CaptureSpec& spec) override;

 private:
  absl::Status WaitForLine() const;

  std::FILE* const answers_;
  const std::unique_ptr<capture::StimulusPresenter> presenter_;
  const std::function<bool()> cancelled_;
  std::optional<CaptureSpec> shown_;
};

}  // namespace eyebox::service::cli

#endif  // EYEBOX_SERVICE_CLI_ASKING_PRESENTER_H_
