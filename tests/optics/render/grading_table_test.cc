#include "optics/render/grading_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "optics/render/log_c.h"
#include "optics/render/stages.h"

namespace eyebox::optics {
namespace {

// The textbook conversions with sectors, the guard added to both divisors.
Rgb ByTheBook(const Rgb& c, double guard) {
  const double high = std::max({c[0], c[1], c[2]});
  const double low = std::min({c[0], c[1], c[2]});
  const double divisor = 6 * (high - low) + guard;
  double hue = 0;
  if (high == c[0]) hue = (c[1] - c[2]) / divisor;
  if (high == c[1] && high != c[0]) hue = (c[2] - c[0]) / divisor + 1.0 / 3;
  if (high == c[2] && high != c[0] && high != c[1]) hue = (c[0] - c[1]) / divisor + 2.0 / 3;
  const double saturation = (high - low) / (high + guard);
  Rgb back;
  const std::array<double, 3> shift = {1, 2.0 / 3, 1.0 / 3};
  for (int i = 0; i < 3; ++i) {
    const double turned = hue + shift[i] - std::floor(hue + shift[i]);
    const double ramp = std::clamp(std::abs(turned * 6 - 3) - 1, 0.0, 1.0);
    back[i] = high * (1 + saturation * (ramp - 1));
  }
  return back;
}

TEST(GradingTableTest, HsvAgreesWithTheTextbook) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> exponent(-5, 2);
  for (int i = 0; i < 20000; ++i) {
    const Rgb c = {std::pow(10, exponent(random)), std::pow(10, exponent(random)),
                   std::pow(10, exponent(random))};
    const Rgb ours = ThroughHsv(c, 1e-4);
    const Rgb book = ByTheBook(c, 1e-4);
    const double high = std::max({c[0], c[1], c[2]});
    for (int channel = 0; channel < 3; ++channel) {
      ASSERT_NEAR(ours[channel], book[channel], 1e-13 * high) << c[0] << " " << c[1] << " " << c[2];
    }
  }
}

TEST(GradingTableTest, HsvRaisesTheDarkestChannelAndKeepsGreys) {
  EXPECT_EQ(ThroughHsv({0.3, 0.3, 0.3}, 1e-4), (Rgb{0.3, 0.3, 0.3}));
  EXPECT_EQ(ThroughHsv({0, 0, 0}, 1e-4), (Rgb{0, 0, 0}));
  const Rgb turned = ThroughHsv({0.8, 0, 0}, 1e-4);
  EXPECT_EQ(turned[0], 0.8);
  EXPECT_NEAR(turned[1], 1e-4, 1e-7);
  EXPECT_EQ(turned[1], turned[2]);
}

TEST(GradingTableTest, NeutralTableIsTheIdentityAtItsKnots) {
  const ColourTable table = GradingTable(32, nullptr, {.through_hsv = false, .half_floats = false});
  ASSERT_EQ(table.entries.size(), 32768);
  EXPECT_EQ(table.entries[0], (Rgb{0, 0, 0}));  // decodes to below 0, which is cut
  const LogCTable stage{std::make_shared<const ColourTable>(table)};
  for (int i = 2; i < 32; ++i) {
    const double u = LogCToLinear(i / 31.0);
    EXPECT_NEAR(stage.Apply({u, u, 0})[0], u, 1e-12 * u);
  }
}

TEST(GradingTableTest, BetweenKnotsTheChordLiesAboveTheIdentity) {
  const LogCTable stage{std::make_shared<const ColourTable>(GradingTable(32, nullptr))};
  const double u = LogCToLinear(20.5 / 31);
  const double excess = stage.Apply({u, u, u})[1] / u - 1;
  EXPECT_GT(excess, 0.010);
  EXPECT_LT(excess, 0.013);
}

TEST(GradingTableTest, ExternalTableIsAppliedAfterGrading) {
  std::vector<double> squares(16);
  for (int i = 0; i < 16; ++i) squares[i] = i;
  const ColourTable external = SeparableTable(squares);
  const ColourTable table = GradingTable(31, &external, {.through_hsv = false});
  // Knot 2 k of 31 is knot k of 16; the second knot of 16 decodes to a light above 0.
  for (int k = 2; k < 16; ++k) {
    EXPECT_NEAR(table.entries[static_cast<size_t>(2 * k) * (1 + 31 + 961)][2], k, 0.01) << k;
  }
}

}  // namespace
}  // namespace eyebox::optics
