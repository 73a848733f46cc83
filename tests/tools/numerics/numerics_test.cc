// Every promise of the numerics table, over a coarse grid; and what single precision may cost.
#include <gtest/gtest.h>

#include <cmath>

#include "fit/field/common_exponent.h"
#include "tests/tools/numerics/single_precision.h"
#include "tests/tools/numerics/worst_case.h"

namespace eyebox::numerics {
namespace {

TEST(NumericsTest, NothingIsAboveWhatItsCommentPromises) {
  for (const Row& row : AllRows({1})) {
    EXPECT_TRUE(row.Kept()) << row.function << ": " << row.worst << " instead of " << row.promised
                            << " at " << row.where;
    EXPECT_GT(row.points, 0u) << row.function;
  }
}

TEST(NumericsTest, ABrokenPromiseIsSeen) {
  WorstCase worst("f", 1e-15);
  worst.Compare(1 + 4e-15, 1, {{"x", 1}});
  EXPECT_FALSE(worst.row().Kept());
  EXPECT_EQ(worst.row().where, "x 1");
  WorstCase not_finite("f", 1);
  not_finite.Compare(std::nan(""), 1, {{"x", 1}});
  EXPECT_FALSE(not_finite.row().Kept());
}

// A table is planned for errors of a percent or so; a tenth of that is the most that the storage of
// a stack may cost. It costs less than a thousandth of that.
TEST(NumericsTest, SinglePrecisionCostsNextToNothingOverTheExtremeGrid) {
  for (const PrecisionLoss& loss : MeasurePrecisionLoss(/*dense=*/false)) {
    SCOPED_TRACE(::testing::Message()
                 << "gamma " << loss.gamma << ", black " << loss.black << ", white "
                 << loss.white_cd_m2 << ", levels " << loss.levels);
    EXPECT_LT(loss.gamma_float64, 1e-12);
    EXPECT_LT(loss.gamma_float32, fit::kSinglePrecisionLoss);
    EXPECT_LT(loss.luminance_float32, fit::kSinglePrecisionLoss);
    EXPECT_GE(loss.condition, 1);
  }
}

}  // namespace
}  // namespace eyebox::numerics
