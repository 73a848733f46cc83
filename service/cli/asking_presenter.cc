#include "service/cli/asking_presenter.h"

#include <poll.h>
#include <unistd.h>

#include <string>

#include "service/stimulus_words.h"

namespace eyebox::service::cli {
namespace {

constexpr int kLook_ms = 100;  // between two looks at `cancelled`

}  // namespace

absl::Status AskingPresenter::Present(const CaptureSpec& spec) {
  if (!shown_ || !IsSameScene(*shown_, spec)) {
    std::fprintf(stderr, "\neyebox: %s; then Enter: ", WhatToShow(spec).c_str());
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
