#include <gmock/gmock.h>
#include <google/protobuf/text_format.h>
#include <gtest/gtest.h>

#include <string>

#include "service/results/activation.h"

namespace eyebox::service {
namespace {

using testing::HasSubstr;

v1::ActivationResult FromText(const std::string& text) {
  v1::ActivationResult result;
  EXPECT_TRUE(google::protobuf::TextFormat::ParseFromString(text, &result));
  return result;
}

const char kComplete[] = R"pb(
  parameters { name: "minimum_luminance" value: 0.2 sigma: 0.1 unit: "cd/m2" }
  parameters { name: "luminance_range" value: 58 sigma: 0.3 unit: "cd/m2" }
  parameters { name: "cutoff_drive" value: 0.03 unit: "1" }
  parameters { name: "gamma" value: 2.3 unit: "1" }
  covariance: [ 0.01, -0.02, 0, 0, -0.02, 0.09, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0 ]
  luminance_unit: "cd/m2")pb";

TEST(ActivationResult, IsReadBack) {
  const auto activation = ActivationOf(FromText(kComplete), "fit.json");
  ASSERT_TRUE(activation.ok()) << activation.status();
  EXPECT_EQ(activation->minimum_luminance, 0.2);
  EXPECT_EQ(activation->luminance_range, 58);
  EXPECT_EQ(activation->cutoff_drive, 0.03);
  EXPECT_EQ(activation->gamma, 2.3);
}

TEST(ActivationResult, WhiteIsTheSumOfCorrelatedParts) {
  const v1::Parameter white = MaximumLuminance(FromText(kComplete));
  EXPECT_DOUBLE_EQ(white.value(), 58.2);
  EXPECT_DOUBLE_EQ(white.sigma(), std::sqrt(0.01 + 0.09 - 2 * 0.02));
}

TEST(ActivationResult, AnAbsentOrImpossibleParameterIsNamed) {
  const auto complaint = [](int parameter, double value) {
    v1::ActivationResult result = FromText(kComplete);
    result.mutable_parameters(parameter)->set_value(value);
    const auto activation = ActivationOf(result, "fit.json");
    EXPECT_TRUE(absl::IsInvalidArgument(activation.status()));
    return std::string(activation.status().message());
  };
  EXPECT_THAT(complaint(0, -1), AllOf(HasSubstr("fit.json"), HasSubstr("minimum_luminance")));
  EXPECT_THAT(complaint(1, 0), HasSubstr("luminance_range"));
  EXPECT_THAT(complaint(2, 1), HasSubstr("cutoff_drive"));
  EXPECT_THAT(complaint(3, 0), HasSubstr("gamma"));
  EXPECT_THAT(complaint(3, std::nan("")), HasSubstr("gamma"));
  EXPECT_THAT(std::string(ActivationOf({}, "fit.json").status().message()),
              HasSubstr("no parameter minimum_luminance"));
}

}  // namespace
}  // namespace eyebox::service
