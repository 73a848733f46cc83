#include "service/cli/asking_presenter.h"

#include <poll.h>
#include <unistd.h>

#include <string>

#include "absl/strings/str_format.h"

namespace eyebox::service::cli {
namespace {

constexpr int kLook_ms = 100;  // between two looks at `cancelled`

bool IsShown(const std::optional<CaptureSpec>& shown, const CaptureSpec& spec) {
  return shown && shown->kind == spec.kind && shown->stimulus == spec.stimulus &&
         shown->luminance_cd_m2 == spec.luminance_cd_m2;
}

std::string Drive(const Stimulus& stimulus) {
  if (!stimulus.drive) return "1";
  const DriveRgb& drive = *stimulus.drive;
  if (drive[0] == drive[1] && drive[1] == drive[2]) return absl::StrFormat("%g", drive[0]);
  return absl::StrFormat("(%g, %g, %g)", drive[0], drive[1], drive[2]);
}

std::string Request(const CaptureSpec& spec) {
  if (spec.kind == FrameKind::kDark) return "cover the lens, so that no light reaches it";
  if (spec.kind == FrameKind::kFlat) {
    const std::string luminance =
        spec.luminance_cd_m2 ? absl::StrFormat(" of %g cd/m2", *spec.luminance_cd_m2) : "";
    return "put the uniform reference" + luminance + " before the lens";
  }
  const std::string drive = Drive(spec.stimulus);
  switch (spec.stimulus.pattern) {
    case StimulusPattern::kFullField:
      return "show a steady full field of drive " + drive;
    case StimulusPattern::kDisk:
      return absl::StrFormat("show a disk of %g deg and drive %s on drive 0",
                             spec.stimulus.diameter_deg, drive);
    case StimulusPattern::kBlackDisk:
      return absl::StrFormat("show a disk of %g deg and drive 0 on drive %s",
                             spec.stimulus.diameter_deg, drive);
  }
  return "show the next stimulus";
}

}  // namespace

absl::Status AskingPresenter::Present(const CaptureSpec& spec) {
  if (!IsShown(shown_, spec)) {
    std::fprintf(stderr, "\neyebox: %s; then Enter: ", Request(spec).c_str());
    if (absl::Status status = WaitForLine(); !status.ok()) return status;
    shown_ = spec;
  }
  return presenter_ ? presenter_->Present(spec) : absl::OkStatus();
}

// Byte by byte and without a buffer, so that poll() tells of every one that waits.
absl::Status AskingPresenter::WaitForLine() const {
  const int answers = ::fileno(answers_);
  while (true) {
    if (cancelled_ && cancelled_()) return absl::CancelledError("stopped while it was asked");
    pollfd waiting = {.fd = answers, .events = POLLIN, .revents = 0};
    if (::poll(&waiting, 1, kLook_ms) <= 0) continue;  // nothing yet, or a signal
    char character = 0;
    if (::read(answers, &character, 1) <= 0) {
      return absl::CancelledError(
          "standard input ended while a stimulus was asked for; show what is asked for and answer "
          "each time with a line");
    }
    if (character == '\n') return absl::OkStatus();
  }
}

}  // namespace eyebox::service::cli
