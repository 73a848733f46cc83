// The uncertainty budget of a series of readings, as a person asks for it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>

#include "eyebox/v1/budget.pb.h"
#include "tests/service/run_eyebox.h"

namespace eyebox::service {
namespace {

using testing::HasSubstr;

std::string WriteSeries(const TemporaryFolder& folder) {
  const std::string file = folder / "levels.csv";
  std::ofstream csv(file);
  csv << "m_k,lum,lum_sigma\n";
  for (int i = 0; i <= 12; ++i) {
    const double v = i / 12.0;
    // A ripple of half a percent in place of noise.
    const double luminance = (0.5 + 100 * std::pow(v, 2.2)) * (1 + 0.005 * std::sin(9.0 * i));
    csv << v << "," << luminance << "," << 0.005 * luminance << "\n";
  }
  return file;
}

TEST(CliBudget, FitWritesItsBudgetBesideItsResult) {
  const TemporaryFolder folder;
  const std::string file = folder / "budget.json";
  const std::string fit =
      "fit --csv " + WriteSeries(folder) + " --model power_offset --budget " + file;
  ParsedFrom<v1::ActivationResult>(RunEyebox(fit + " --json"));
  v1::BudgetResult budget;
  ASSERT_TRUE(ReadJson(file, budget).ok());
  EXPECT_EQ(budget.check(), "not checked");
  ASSERT_GT(budget.points_size(), 3);
  for (const v1::BudgetPoint& point : budget.points()) {
    ASSERT_GT(point.terms_size(), 0);
    EXPECT_GT(point.luminance_sigma(), 0);
  }
  const Outcome words = RunEyebox(fit);
  EXPECT_EQ(words.exit_code, 0);
  EXPECT_THAT(words.out, HasSubstr("Shares of the variance at u = 0.2"));
  EXPECT_THAT(words.out, HasSubstr("reading"));
}

TEST(CliBudget, TrialsWithoutABudgetAreRefused) {
  const TemporaryFolder folder;
  const Outcome outcome = RunEyebox("fit --csv " + WriteSeries(folder) + " --budget-trials");
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_THAT(outcome.err, HasSubstr("--budget FILE"));
}

}  // namespace
}  // namespace eyebox::service
