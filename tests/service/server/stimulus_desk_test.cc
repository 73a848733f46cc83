// Where a capture job and its clients meet, and the threads that jobs run in.
#include "service/server/jobs/stimulus_desk.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <future>
#include <string>

#include "service/server/jobs/lanes.h"

namespace eyebox::service {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kLong(60'000);

bool Never() { return false; }

// What a client waits for.
struct Bell {
  std::promise<void> rung;
  std::function<void()> AsChanged() {
    return [this] { rung.set_value(); };
  }
  void Await() { rung.get_future().wait(); }
};

TEST(StimulusDeskTest, JobGoesOnWhenWhatItWantedIsShown) {
  Bell bell;
  StimulusDesk desk(100, bell.AsChanged());
  desk.Open(StimulusDesk::Way::kPlan);
  auto job =
      std::async(std::launch::async, [&] { return desk.AwaitShown({}, "show it", Never, kLong); });
  bell.Await();
  const auto wanted = desk.ToShow();
  ASSERT_TRUE(wanted.ok() && *wanted);
  EXPECT_EQ((*wanted)->step, 101u);
  EXPECT_EQ((*wanted)->instruction, "show it");
  EXPECT_TRUE(desk.Shown(100).ok());  // of an earlier attempt: says nothing
  EXPECT_TRUE((*desk.ToShow()).has_value());
  EXPECT_TRUE(desk.Shown(101).ok());
  EXPECT_TRUE(job.get().ok());
  EXPECT_TRUE(desk.Shown(101).ok()) << "saying it twice does no harm";
  EXPECT_EQ(desk.Shown(102).code(), absl::StatusCode::kOutOfRange);
}

TEST(StimulusDeskTest, SilentClientEndsTheWaitWithAdvice) {
  StimulusDesk desk(0, [] {});
  desk.Open(StimulusDesk::Way::kPlan);
  const absl::Status status = desk.AwaitShown({}, "", Never, milliseconds(1));
  EXPECT_EQ(status.code(), absl::StatusCode::kDeadlineExceeded);
  EXPECT_NE(status.message().find("resume"), std::string::npos);
}

TEST(StimulusDeskTest, CancelEndsBothWaits) {
  StimulusDesk desk(0, [] {});
  const auto cancelled = [] { return true; };
  EXPECT_TRUE(absl::IsCancelled(desk.AwaitShown({}, "", cancelled, kLong)));
  EXPECT_TRUE(absl::IsCancelled(desk.AwaitOrder(cancelled, kLong).status()));
}

TEST(StimulusDeskTest, EachWayRefusesTheCallsOfTheOther) {
  StimulusDesk desk(0, [] {});
  EXPECT_TRUE(absl::IsUnavailable(desk.Shown(1))) << "not ready yet";
  desk.Open(StimulusDesk::Way::kSession);
  EXPECT_TRUE(absl::IsFailedPrecondition(desk.Shown(1)));
  EXPECT_TRUE(absl::IsFailedPrecondition(desk.ToShow().status()));
  StimulusDesk plan(0, [] {});
  plan.Open(StimulusDesk::Way::kPlan);
  EXPECT_TRUE(absl::IsFailedPrecondition(plan.Finish()));
  absl::Status refused;
  plan.Place({}, [&](const auto& reply) { refused = reply.status(); });
  EXPECT_TRUE(absl::IsFailedPrecondition(refused));
}

TEST(StimulusDeskTest, OrderIsAnsweredOnceAndASecondOneMeanwhileIsRefused) {
  StimulusDesk desk(0, [] {});
  desk.Open(StimulusDesk::Way::kSession);
  v1::CaptureRequest request;
  request.set_number(7);
  int answers = 0;
  desk.Place(request, [&](const auto& reply) {
    ++answers;
    EXPECT_TRUE(reply.ok());
  });
  absl::Status second;
  desk.Place(request, [&](const auto& reply) { second = reply.status(); });
  EXPECT_TRUE(absl::IsUnavailable(second));
  const auto order = desk.AwaitOrder(Never, kLong);
  ASSERT_TRUE(order.ok());
  EXPECT_EQ(order->request.number(), 7);
  desk.Answer(v1::CaptureReply());
  desk.Answer(v1::CaptureReply());
  EXPECT_EQ(answers, 1);
  EXPECT_TRUE(desk.Finish().ok());
  EXPECT_TRUE(desk.AwaitOrder(Never, kLong)->finish);
}

TEST(StimulusDeskTest, ClosedDeskAnswersWhoeverWaitsAndWhoeverComes) {
  StimulusDesk desk(0, [] {});
  desk.Open(StimulusDesk::Way::kSession);
  absl::Status first;
  absl::Status later;
  desk.Place({}, [&](const auto& reply) { first = reply.status(); });
  desk.Close(absl::UnavailableError("gone"));
  desk.Place({}, [&](const auto& reply) { later = reply.status(); });
  EXPECT_EQ(first.message(), "gone");
  EXPECT_EQ(later.message(), "gone");
}

TEST(LanesTest, CaptureDoesNotWaitForAnAnalysis) {
  Lanes lanes(1);
  std::promise<void> release;
  std::promise<void> captured;
  std::promise<void> analysed;
  lanes.Post({.lane = Lanes::Lane::kAnalysis, .rig = "", .run = [&] {
                release.get_future().wait();
                analysed.set_value();
              }});
  lanes.Post({.lane = Lanes::Lane::kCapture, .rig = "a", .run = [&] { captured.set_value(); }});
  captured.get_future().wait();
  release.set_value();
  analysed.get_future().wait();
}

TEST(LanesTest, RigServesOneJobAtATimeAndOthersPass) {
  Lanes lanes(3);
  std::promise<void> release;
  std::promise<void> other;
  std::promise<void> second;
  std::atomic<bool> first_ended = false;
  std::atomic<bool> overlapped = false;
  lanes.Post({.lane = Lanes::Lane::kCapture, .rig = "a", .run = [&] {
                release.get_future().wait();
                first_ended = true;
              }});
  lanes.Post({.lane = Lanes::Lane::kCapture, .rig = "a", .run = [&] {
                overlapped = !first_ended;
                second.set_value();
              }});
  lanes.Post({.lane = Lanes::Lane::kCapture, .rig = "b", .run = [&] { other.set_value(); }});
  other.get_future().wait();  // passed the second of "a"
  release.set_value();
  second.get_future().wait();
  EXPECT_FALSE(overlapped);
}

}  // namespace
}  // namespace eyebox::service
