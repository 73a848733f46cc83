#include "service/cli/asking_presenter.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <memory>
#include <string>

namespace eyebox::service::cli {
namespace {

using testing::HasSubstr;

CaptureSpec Grey(double drive) {
  CaptureSpec spec;
  spec.stimulus.drive = DriveRgb{drive, drive, drive};
  return spec;
}

CaptureSpec Dark() {
  CaptureSpec spec;
  spec.kind = FrameKind::kDark;
  return spec;
}

struct Close {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

std::unique_ptr<std::FILE, Close> Answers(const std::string& text) {
  std::unique_ptr<std::FILE, Close> file(std::tmpfile());
  std::fputs(text.c_str(), file.get());
  std::rewind(file.get());
  return file;
}

TEST(AskingPresenter, AsksForEachNewStimulusAndWaitsForALine) {
  const auto answers = Answers("\nyes\nunread");
  AskingPresenter presenter(answers.get());
  testing::internal::CaptureStderr();
  EXPECT_TRUE(presenter.Present(Grey(0.5)).ok());
  CaptureSpec longer = Grey(0.5);
  longer.exposure_s = 2;
  EXPECT_TRUE(presenter.Present(longer).ok()) << "the same to look at";
  EXPECT_TRUE(presenter.Present(Dark()).ok());
  const std::string asked = testing::internal::GetCapturedStderr();
  EXPECT_THAT(asked, HasSubstr("full field of drive 0.5"));
  EXPECT_THAT(asked, HasSubstr("cover the lens"));
  EXPECT_EQ(std::fgetc(answers.get()), 'u');
}

TEST(AskingPresenter, EndsWhereTheAnswersDo) {
  const auto answers = Answers("no newline");
  AskingPresenter presenter(answers.get());
  const absl::Status status = presenter.Present(Dark());
  EXPECT_TRUE(absl::IsCancelled(status)) << status;
  EXPECT_THAT(std::string(status.message()), HasSubstr("standard input ended"));
}

}  // namespace
}  // namespace eyebox::service::cli
