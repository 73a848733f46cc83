// A display measured in colour answers coloured drives, with the uncertainty of its fit.
#include "service/display.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "capture/base/file.h"
#include "fit/color/fit_colour.h"
#include "service/result_json.h"
#include "service/results/colour.h"
#include "tests/fit/color/synthetic_display.h"
#include "tests/support/temporary_folder.h"

namespace eyebox::service {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(DisplayTest, ColourAnswersWithASigmaThatRepeatedFitsScatterBy) {
  const fit::ColourModel truth =
      fit::SyntheticDisplay(fit::ColourModelKind::kDriveCrosstalk, {0.09, -0.03, 0.05});
  const fit::Rgb drive = {0.55, 0.35, 0.8};
  double squares = 0;
  double stated = 0;
  constexpr int kFits = 20;
  for (unsigned i = 0; i < kFits; ++i) {
    fit::ColourOptions options;
    options.model = fit::ColourModelKind::kDriveCrosstalk;
    const auto choice =
        fit::ChooseColour(fit::Measure(truth, fit::GreysAndPrimaries(8), 0.01, 100 + i), options);
    ASSERT_TRUE(choice.ok()) << choice.status();
    const TemporaryFolder folder;
    const auto json = ToJson(DescribeColour(*choice));
    ASSERT_TRUE(json.ok());
    ASSERT_TRUE(WriteFileAtomically(folder / "fit.json", *json).ok());
    const auto display = Display::Read(folder / "fit.json");
    ASSERT_TRUE(display.ok()) << display.status();
    EXPECT_THAT(display->Quantities(), ElementsAre("x", "y", "z"));
    const std::vector<v1::Parameter> answer = display->Answer(drive);
    ASSERT_EQ(answer.size(), 3);
    const double off = answer[1].value() - truth.Colour(drive)[1];
    squares += off * off / kFits;
    stated += answer[1].sigma() * answer[1].sigma() / kFits;
  }
  EXPECT_GT(stated / squares, 0.5);
  EXPECT_LT(stated / squares, 2);
}

TEST(DisplayTest, AFileOfAnotherKindIsRefused) {
  const TemporaryFolder folder;
  ASSERT_TRUE(WriteFileAtomically(folder / "fit.json", "{\"parameters\": []}").ok());
  const auto display = Display::Read(folder / "fit.json");
  EXPECT_EQ(display.status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(display.status().message()), HasSubstr("fit.json"));
}

}  // namespace
}  // namespace eyebox::service
