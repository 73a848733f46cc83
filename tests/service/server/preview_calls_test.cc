// Preview and GetPreviewFrame over the socket, of a simulated rig.
#include <gmock/gmock.h>

#include <cmath>
#include <thread>
#include <vector>

#include "eyebox/v1/capture_service.grpc.pb.h"
#include "service/server/preview/preview_hub.h"
#include "tests/service/server/server_fixture.h"

namespace eyebox::service {
namespace {

using grpc::StatusCode;
using testing::HasSubstr;

class PreviewCallsTest : public ServerFixture {
 protected:
  void SetUp() override {
    ServerFixture::SetUp();
    captures_ = v1::CaptureService::NewStub(channel_);
  }

  static v1::PreviewRequest Grey(double drive) {
    v1::PreviewRequest request;
    request.mutable_simulated()->set_name("rig");
    request.mutable_simulated()->set_camera_uri("sim:rift-s-like");
    request.set_drive(drive);
    return request;
  }
  grpc::Status Get(const v1::PreviewRequest& request, v1::PreviewFrame* picture) {
    CallContext context;
    return captures_->GetPreviewFrame(&context, request, picture);
  }

  std::unique_ptr<v1::CaptureService::Stub> captures_;
};

TEST_F(PreviewCallsTest, APictureIsWhatTheCameraSees) {
  v1::PreviewRequest request = Grey(1);
  request.set_exposure_s(0.0125);
  request.set_most_width_px(50);
  v1::PreviewFrame picture;
  const grpc::Status status = Get(request, &picture);
  ASSERT_TRUE(status.ok()) << status.error_message();
  EXPECT_EQ(picture.block_px(), 4);  // 160 px across
  EXPECT_EQ(picture.width_px(), 40);
  EXPECT_EQ(picture.height_px(), 30);
  ASSERT_EQ(picture.pixels().size(), 40u * 30);
  EXPECT_EQ(picture.full_scale_dn(), 4095);
  EXPECT_GT(picture.mean_dn(), 1000);
  EXPECT_LT(picture.lowest_dn(), picture.mean_dn());
  EXPECT_GT(picture.highest_dn(), picture.mean_dn());
  double sum = 0;
  for (const char pixel : picture.pixels()) sum += static_cast<uint8_t>(pixel);
  EXPECT_NEAR(sum / 1200, 255 * picture.mean_dn() / 4095, 1);
  v1::PreviewFrame dark;
  ASSERT_TRUE(Get(Grey(0), &dark).ok());
  EXPECT_LT(dark.mean_dn(), picture.mean_dn() / 3);
}

TEST_F(PreviewCallsTest, EachPictureIsNewerThanTheLast) {
  v1::PreviewRequest request = Grey(0.5);
  v1::PreviewFrame first;
  ASSERT_TRUE(Get(request, &first).ok());
  request.set_after_frame(first.frame());
  v1::PreviewFrame second;
  ASSERT_TRUE(Get(request, &second).ok());
  EXPECT_GT(second.frame(), first.frame());
}

TEST_F(PreviewCallsTest, PicturesAscendAndSayHowManyWereLeftOut) {
  CallContext context;
  const auto stream = captures_->Preview(&context, Grey(0.5));
  v1::PreviewFrame picture;
  uint64_t last = 0;
  for (int i = 0; i < 4; ++i) {
    ASSERT_TRUE(stream->Read(&picture));
    EXPECT_EQ(picture.frame(), last == 0 ? picture.frame() : last + 1 + picture.dropped());
    last = picture.frame();
  }
  context.TryCancel();
  EXPECT_EQ(stream->Finish().error_code(), StatusCode::CANCELLED);
}

// What gRPC has taken in already still comes, little through this channel; the picture after it is
// the newest there is.
TEST_F(PreviewCallsTest, WhoReadsLateGetsTheNewestAndNotABacklog) {
  constexpr int kMostTakenIn = 25;  // of 19 kB
  grpc::ChannelArguments narrow;
  narrow.SetInt(GRPC_ARG_HTTP2_STREAM_LOOKAHEAD_BYTES, 16384);
  narrow.SetInt(GRPC_ARG_HTTP2_BDP_PROBE, 0);
  const auto stub = v1::CaptureService::NewStub(
      grpc::CreateCustomChannel(Address(), grpc::InsecureChannelCredentials(), narrow));
  CallContext context;
  const auto stream = stub->Preview(&context, Grey(0.5));
  v1::PreviewFrame picture;
  ASSERT_TRUE(stream->Read(&picture));
  uint64_t last = picture.frame();
  uint64_t dropped = 0;
  int read = 0;
  for (; dropped == 0 && read < kMostTakenIn; ++read) {
    if (read == 0) std::this_thread::sleep_for(std::chrono::seconds(3));  // thirty pictures
    ASSERT_TRUE(stream->Read(&picture));
    EXPECT_EQ(picture.frame(), last + 1 + picture.dropped());
    last = picture.frame();
    dropped = picture.dropped();
  }
  EXPECT_GT(dropped, 0u) << "after " << read << " pictures";
  context.TryCancel();
  EXPECT_EQ(stream->Finish().error_code(), StatusCode::CANCELLED);
}

TEST_F(PreviewCallsTest, OneSlotHoldsTheNewestPicture) {
  PreviewLook look;
  int told = 0;
  const uint64_t listener = look.Listen([&told] { ++told; });
  EXPECT_EQ(*look.Newest(), nullptr);
  for (int i = 0; i < 5; ++i) look.Publish({});
  EXPECT_EQ(told, 5);
  EXPECT_EQ((*look.Newest())->frame(), 5u);
  EXPECT_EQ(look.Unwatched().count(), 0);
  look.Leave(listener);
  look.End(absl::CancelledError("over"));
  EXPECT_EQ(told, 5);
  EXPECT_TRUE(absl::IsCancelled(look.Newest().status()));
}

TEST_F(PreviewCallsTest, AJobThatCapturesEndsEveryPreviewAndAllowsNone) {
  CallContext context;
  const auto stream = captures_->Preview(&context, Grey(0.5));
  v1::PreviewFrame picture;
  ASSERT_TRUE(stream->Read(&picture));
  const v1::Job job = CreateOk("busy");  // a run of a rig, which waits in the test's hands
  while (stream->Read(&picture)) {
  }
  const grpc::Status ended = stream->Finish();
  EXPECT_EQ(ended.error_code(), StatusCode::FAILED_PRECONDITION);
  EXPECT_THAT(ended.error_message(), HasSubstr("\"busy\""));
  const grpc::Status refused = Get(Grey(0.5), &picture);
  EXPECT_EQ(refused.error_code(), StatusCode::FAILED_PRECONDITION);
  EXPECT_THAT(refused.error_message(), HasSubstr("\"busy\""));
  work_.AllowAll();
  EXPECT_EQ(WaitOk(job.name()).state(), v1::JOB_STATE_SUCCEEDED);
  EXPECT_TRUE(Get(Grey(0.5), &picture).ok());
}

TEST_F(PreviewCallsTest, AnotherViewIsRefusedWhileSomeoneLooks) {
  CallContext context;
  const auto stream = captures_->Preview(&context, Grey(0.5));
  v1::PreviewFrame picture;
  ASSERT_TRUE(stream->Read(&picture));
  EXPECT_TRUE(Get(Grey(0.5), &picture).ok());
  EXPECT_EQ(Get(Grey(0.25), &picture).error_code(), StatusCode::FAILED_PRECONDITION);
  context.TryCancel();
  stream->Finish();
  grpc::Status status;
  for (int i = 0; i < 600; ++i) {
    status = Get(Grey(0.25), &picture);
    if (status.ok()) break;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  EXPECT_TRUE(status.ok()) << status.error_message();
}

TEST_F(PreviewCallsTest, RequestsThatMakeNoSenseAreRefusedByField) {
  const auto with = [](const auto& change) {
    v1::PreviewRequest request = Grey(0.5);
    change(request);
    return request;
  };
  const std::pair<v1::PreviewRequest, std::string> cases[] = {
      {with([](auto& r) { r.clear_simulated(); }), "source"},
      {with([](auto& r) { r.set_rig("rigs/../secret"); }), "rig"},
      {with([](auto& r) { r.set_exposure_s(-1); }), "exposure_s"},
      {with([](auto& r) { r.set_exposure_s(11); }), "exposure_s"},
      {with([](auto& r) { r.set_gain_db(std::nan("")); }), "gain_db"},
      {with([](auto& r) { r.set_most_width_px(8); }), "most_width_px"},
      {with([](auto& r) { r.set_drive(1.5); }), "drive"},
      {with([](auto& r) { r.mutable_simulated()->set_camera_uri("v4l2:/dev/video0"); }),
       "rig.camera_uri"},
  };
  for (const auto& [request, field] : cases) {
    v1::PreviewFrame picture;
    const grpc::Status status = Get(request, &picture);
    EXPECT_EQ(status.error_code(), StatusCode::INVALID_ARGUMENT) << field;
    EXPECT_THAT(status.error_message(), HasSubstr(field));
    CallContext context;
    const auto stream = captures_->Preview(&context, request);
    EXPECT_FALSE(stream->Read(&picture));
    EXPECT_EQ(stream->Finish().error_code(), StatusCode::INVALID_ARGUMENT) << field;
  }
  v1::PreviewRequest missing;
  missing.set_rig("rigs/nowhere");
  v1::PreviewFrame picture;
  EXPECT_EQ(Get(missing, &picture).error_code(), StatusCode::NOT_FOUND);
}

}  // namespace
}  // namespace eyebox::service
