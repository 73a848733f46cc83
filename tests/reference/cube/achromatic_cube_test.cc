// From a monitor's real grey series to its table, with what the table is certified to leave.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "capture/base/file.h"
#include "fit/activation/fit_activation.h"
#include "fit/cube/table_file.h"
#include "tests/fit/cube/evaluator.h"

namespace eyebox::fit {
namespace {

class AchromaticCubeTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::filesystem::path file = std::filesystem::path(EYEBOX_SOURCE_DIR) /
                                       "../shared/reference/luminance/achromatic_420.csv";
    if (!std::filesystem::exists(file)) {
      GTEST_SKIP() << file << " is absent: no real series to design for";
    }
    const auto series = ReadLevelSeriesCsv(file);
    ASSERT_TRUE(series.ok()) << series.status();
    const auto fit =
        FitActivation(*series, ActivationModel::kGammaWithCutoff, Weighting::kRelative);
    ASSERT_TRUE(fit.ok()) << fit.status();
    series_ = *series;
    activation_ = fit->activation;
  }

  evaluator::Display Display() const {
    return {activation_.minimum_luminance, activation_.luminance_range, activation_.cutoff_drive,
            activation_.gamma};
  }

  LevelSeries series_;
  Activation activation_;
};

struct Promise {
  int size;
  double max_relative;
};

TEST_F(AchromaticCubeTest, CertifiedAsPromised) {
  for (const Promise& promise : {Promise{32, 0.008}, Promise{64, 0.002}}) {
    const auto table = DesignTable(activation_, TableTarget::kHdrp, promise.size);
    ASSERT_TRUE(table.ok()) << table.status();
    const auto file = std::filesystem::path(testing::TempDir()) / "achromatic_420.cube";
    ASSERT_TRUE(WriteFileAtomically(file, *EncodeTable(*table)).ok());
    const auto cube = ReadCube(file);
    ASSERT_TRUE(cube.ok()) << cube.status();
    const auto measured = evaluator::Measure(Display(), *cube, TableTarget::kHdrp, 1, 0.05L, 20011);
    std::printf("%d knots: certified %.3f %% (rms %.3f %%) at u = %.3f, confirmed %.3Lf %%\n",
                promise.size, 100 * table->certificate.max_relative,
                100 * table->certificate.rms_relative, table->certificate.at_u,
                100 * measured.worst);
    EXPECT_LE(table->certificate.max_relative, promise.max_relative);
    EXPECT_LE(measured.worst, table->certificate.max_relative * 1.002);
  }
}

// What was measured, not the fit, is asked for: the table must answer with the drive value that was
// set for it.
TEST_F(AchromaticCubeTest, AsksForTheDriveThatGaveEachMeasuredLuminance) {
  const auto table = *DesignTable(activation_, TableTarget::kHdrp, 32);
  const double white = activation_.Luminance(1);
  int checked = 0;
  for (const LevelReading& reading : series_.readings) {
    const double x = reading.luminance / white;
    if (x < 0.05 || x > 1) continue;
    EXPECT_NEAR(DriveThroughTable(table, x), reading.drive, 0.01);
    ++checked;
  }
  EXPECT_GE(checked, 5);
}

}  // namespace
}  // namespace eyebox::fit
