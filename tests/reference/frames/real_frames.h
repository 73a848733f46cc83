// Seven real exposures of one scene under two narrow bands, 8-bit Bayer, and their darks.
#ifndef EYEBOX_TESTS_REFERENCE_FRAMES_REAL_FRAMES_H_
#define EYEBOX_TESTS_REFERENCE_FRAMES_REAL_FRAMES_H_

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "capture/base/image_file.h"
#include "optics/reduce/reduce_level.h"
#include "optics/sensor/defect_map.h"
#include "optics/sensor/photon_transfer.h"

namespace eyebox::optics {

inline constexpr SensorRange kEightBits{8};

struct IndexRow {
  std::string file, kind, series;
  double exposure_s = 0;
};

inline std::filesystem::path Folder() {
  return std::filesystem::path(EYEBOX_SOURCE_DIR) / "../shared/reference/frames";
}

// file,kind,exposure_s,gain_db,series,repeat
inline std::vector<IndexRow> ReadIndex() {
  std::ifstream stream(Folder() / "index.csv");
  std::string line;
  std::getline(stream, line);
  std::vector<IndexRow> rows;
  while (std::getline(stream, line)) {
    std::istringstream fields(line);
    std::string exposure, gain;
    IndexRow row;
    std::getline(fields, row.file, ',');
    std::getline(fields, row.kind, ',');
    std::getline(fields, exposure, ',');
    std::getline(fields, gain, ',');
    std::getline(fields, row.series, ',');
    row.exposure_s = std::stod(exposure);
    rows.push_back(row);
  }
  return rows;
}

class RealBracketTest : public ::testing::Test {
 protected:
  using Frames = std::map<double, std::vector<Image<uint16_t>>>;  // by exposure

  void SetUp() override {
    if (!std::filesystem::exists(Folder() / "index.csv")) {
      GTEST_SKIP() << Folder() << " is absent: no real frames to reduce";
    }
    for (const IndexRow& row : ReadIndex()) {
      const auto image = ReadGreyImage(Folder() / row.file);
      ASSERT_TRUE(image.ok()) << image.status();
      (row.kind == "dark" ? darks_ : lights_[row.series])[row.exposure_s].push_back(
          image->pixels_dn);
    }
    Calibrate();
  }

  static std::vector<Stack> StackAll(const Frames& frames) {
    std::vector<Stack> stacks;
    for (const auto& [exposure_s, images] : frames) {
      FrameStacker stacker({exposure_s, 0}, kEightBits);
      for (const auto& image : images) {
        EXPECT_TRUE(stacker.Add({image.pixels(), image.size()}).ok());
      }
      stacks.push_back(*stacker.Finish());
    }
    return stacks;
  }

  static void AddCaptures(FrameKind kind, const Frames& frames, PhotonTransfer& transfer) {
    for (const auto& [exposure_s, images] : frames) {
      transfer.BeginCapture(kind);
      for (const auto& image : images) {
        ASSERT_TRUE(transfer.AddFrame({image.pixels(), image.size()}).ok());
      }
    }
  }

  void Calibrate() {
    const std::vector<Stack> darks = StackAll(darks_);
    calibration_.defects = *FindHotPixels(darks);
    PhotonTransfer transfer(darks.front(), calibration_.defects.defective);
    AddCaptures(FrameKind::kDark, darks_, transfer);
    for (const auto& [series, frames] : lights_) AddCaptures(FrameKind::kLight, frames, transfer);
    const auto noise = transfer.Fit();
    ASSERT_TRUE(noise.ok()) << noise.status();
    calibration_.noise = *noise;
    for (const Stack& dark : darks) {
      calibration_.darks.push_back(*MeasureDark(dark, calibration_.noise));
    }
  }

  ReducedLevel Reduce(const std::string& series) {
    return *ReduceLevel(StackAll(lights_[series]), calibration_);
  }

  Frames darks_;
  std::map<std::string, Frames> lights_;
  Calibration calibration_;
};

}  // namespace eyebox::optics

#endif  // EYEBOX_TESTS_REFERENCE_FRAMES_REAL_FRAMES_H_
