#include "optics/sensor/photon_transfer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/optics/forward_model.h"

namespace eyebox::optics {
namespace {

using ::testing::HasSubstr;

constexpr ImageSize kSize{160, 120};

void AddCapture(ForwardCamera& camera, FrameKind kind, double electrons, int frames,
                PhotonTransfer& transfer, double drift = 0) {
  transfer.BeginCapture(kind);
  for (int k = 0; k < frames; ++k) {
    const auto rate = static_cast<float>(electrons * (1 + drift * k));
    const Image<uint16_t> frame = camera.Expose(Image<float>(kSize, rate), 1.0);
    ASSERT_TRUE(transfer.AddFrame({frame.pixels(), frame.size()}).ok());
  }
}

TEST(PhotonTransferTest, RecoversGainAndReadNoiseWithinItsUncertainty) {
  double squared_pulls = 0;
  constexpr int kTrials = 20;
  for (int seed = 1; seed <= kTrials; ++seed) {
    ForwardCamera camera(kSize, seed);
    PhotonTransfer transfer(camera.RecordDark(1.0, 4), {});
    AddCapture(camera, FrameKind::kDark, 0, 2, transfer);
    for (const double electrons : {200, 2000, 5000, 9000}) {
      AddCapture(camera, FrameKind::kLight, electrons, 2, transfer);
    }
    const NoiseModel noise = *transfer.Fit();
    EXPECT_NEAR(noise.gain_dn_per_e, 0.25, 4 * noise.gain_sigma_dn_per_e);
    EXPECT_LT(noise.gain_sigma_dn_per_e, 0.02 * 0.25);
    EXPECT_NEAR(noise.read_variance_dn2, 4, 0.4);
    EXPECT_EQ(noise.noise_source, "pairs of repeats");
    squared_pulls += std::pow((noise.gain_dn_per_e - 0.25) / noise.gain_sigma_dn_per_e, 2);
  }
  // chi2 of 20 degrees of freedom: 99.9 % interval.
  EXPECT_GT(squared_pulls, 5.9);
  EXPECT_LT(squared_pulls, 45.3);
}

TEST(PhotonTransferTest, DriftBetweenRepeatsDoesNotCountAsNoise) {
  ForwardCamera camera(kSize, 3);
  PhotonTransfer transfer(camera.RecordDark(1.0, 4), {});
  AddCapture(camera, FrameKind::kDark, 0, 2, transfer);
  // 5 % at 8000 electrons: 400 electrons, where shot noise is 89.
  for (const double electrons : {2000, 8000}) {
    AddCapture(camera, FrameKind::kLight, electrons, 2, transfer, 0.05);
  }
  const NoiseModel noise = *transfer.Fit();
  EXPECT_NEAR(noise.gain_dn_per_e, 0.25, 0.01);
}

TEST(PhotonTransferTest, HotPixelsTakeNoPart) {
  ForwardCamera camera(kSize, 4);
  for (int x = 0; x < kSize.width_px; ++x) camera.dark_rate_e_s.at(x, 7) = 3000;
  const Stack bias = camera.RecordDark(1e-3, 4);
  const Stack longest = camera.RecordDark(1.0, 4);
  const DefectMap defects = *FindHotPixels(std::vector{bias, longest});
  PhotonTransfer transfer(bias, defects.defective);
  AddCapture(camera, FrameKind::kDark, 0, 2, transfer);
  AddCapture(camera, FrameKind::kLight, 6000, 2, transfer);
  EXPECT_NEAR(transfer.Fit()->read_variance_dn2, 4, 0.3);
}

TEST(PhotonTransferTest, SingleFramesGiveAnUpperBoundFromNeighbours) {
  ForwardCamera camera(kSize, 5);
  for (auto& r : camera.response.pixels()) r = 1;
  PhotonTransfer transfer(camera.RecordDark(1.0, 4), {});
  AddCapture(camera, FrameKind::kDark, 0, 2, transfer);
  for (const double electrons : {500, 2000, 5000, 9000}) {
    AddCapture(camera, FrameKind::kLight, electrons, 1, transfer);
  }
  const NoiseModel noise = *transfer.Fit();
  EXPECT_EQ(noise.noise_source, "spatial differences");
  EXPECT_NEAR(noise.gain_dn_per_e, 0.25, 0.02);
  EXPECT_NEAR(noise.gain_dn_per_e, 0.25, 4 * noise.gain_sigma_dn_per_e);
}

TEST(PhotonTransferTest, EdgesInAMinorityOfTilesDoNotLiftTheSpatialEstimate) {
  ForwardCamera camera(kSize, 6);
  PhotonTransfer transfer(camera.RecordDark(1.0, 4), {});
  AddCapture(camera, FrameKind::kDark, 0, 2, transfer);
  for (const float electrons : {1000.0F, 3000.0F, 8000.0F}) {
    Image<float> scene(kSize, electrons);
    for (int y = 0; y < kSize.height_px; ++y) {
      for (int x = 50; x < 60; ++x) scene.at(x, y) = 0.5F * electrons;
    }
    transfer.BeginCapture(FrameKind::kLight);
    const Image<uint16_t> frame = camera.Expose(scene, 1.0);
    ASSERT_TRUE(transfer.AddFrame({frame.pixels(), frame.size()}).ok());
  }
  EXPECT_NEAR(transfer.Fit()->gain_dn_per_e, 0.25, 0.03);
}

TEST(PhotonTransferTest, DarksAloneAreRejectedWithWhatToRecord) {
  ForwardCamera camera(kSize, 7);
  PhotonTransfer transfer(camera.RecordDark(1.0, 4), {});
  AddCapture(camera, FrameKind::kDark, 0, 4, transfer);
  const auto noise = transfer.Fit();
  EXPECT_EQ(noise.status().code(), absl::StatusCode::kFailedPrecondition);
  EXPECT_THAT(std::string(noise.status().message()), HasSubstr("two frames each"));
}

TEST(PhotonTransferTest, SaturatedLightIsNotAPoint) {
  ForwardCamera camera(kSize, 8);
  PhotonTransfer transfer(camera.RecordDark(1.0, 4), {});
  AddCapture(camera, FrameKind::kLight, 1e5, 2, transfer);
  EXPECT_TRUE(transfer.Points().empty());
  EXPECT_FALSE(transfer.Fit().ok());
}

TEST(PhotonTransferTest, FrameOfAnotherSizeIsRejected) {
  ForwardCamera camera(kSize, 9);
  PhotonTransfer transfer(camera.RecordDark(1.0, 1), {});
  const Image<uint16_t> small({8, 8});
  EXPECT_EQ(transfer.AddFrame({small.pixels(), small.size()}).code(),
            absl::StatusCode::kInvalidArgument);
}

TEST(DefectMapTest, FindsTheHotPixelsAndNoOthers) {
  ForwardCamera camera(kSize, 10);
  for (auto& rate : camera.dark_rate_e_s.pixels()) rate = 20;
  for (int k = 0; k < 10; ++k) camera.dark_rate_e_s.at(10 * k + 3, 5 * k + 1) = 4000;
  const std::vector<Stack> darks = {camera.RecordDark(0.01, 2), camera.RecordDark(1.0, 2)};
  const DefectMap map = *FindHotPixels(darks);
  EXPECT_DOUBLE_EQ(map.hot_share, 10.0 / static_cast<double>(kSize.PixelCount()));
  for (int k = 0; k < 10; ++k) EXPECT_EQ(map.defective.at(10 * k + 3, 5 * k + 1), 1);
  EXPECT_NEAR(map.median_dark_rate_dn_s, 20 * 0.25, 0.5);
}

TEST(DefectMapTest, NoDarksAreRejected) {
  EXPECT_EQ(FindHotPixels({}).status().code(), absl::StatusCode::kFailedPrecondition);
}

}  // namespace
}  // namespace eyebox::optics
