// Neighbours of one colour: next to each other on a grey sensor, two apart in a mosaic.
#include <gtest/gtest.h>

#include "service/steps/captures.h"

namespace eyebox::service {
namespace {

int PeriodOf(const std::string& pixel_format, capture::RecordingOrigin origin) {
  capture::RecordingHeader header;
  header.origin = origin;
  header.camera.pixel_format = pixel_format;
  return ColourPeriodPx(header);
}

TEST(ColourPeriod, IsOneOfAGreySensor) {
  for (const char* format : {"Mono8", "Mono12p", "Mono12Packed", "GREY", "Y10", "Y12P", "Y16"}) {
    EXPECT_EQ(PeriodOf(format, capture::RecordingOrigin::kCaptured), 1) << format;
  }
  EXPECT_EQ(PeriodOf("", capture::RecordingOrigin::kSimulated), 1);
}

TEST(ColourPeriod, IsTwoOfAMosaicAndWhereNobodyTells) {
  for (const char* format : {"BayerRG8", "BayerGB12", "RG10", "YUYV", ""}) {
    EXPECT_EQ(PeriodOf(format, capture::RecordingOrigin::kCaptured), 2) << format;
  }
  EXPECT_EQ(PeriodOf("", capture::RecordingOrigin::kImported), 2);
}

}  // namespace
}  // namespace eyebox::service
