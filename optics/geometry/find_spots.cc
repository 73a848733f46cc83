#include <algorithm>
#include <cmath>

#include "opencv2/core.hpp"
#include "opencv2/imgproc.hpp"
#include "optics/geometry/find_dots.h"

namespace eyebox::optics {
namespace {

constexpr int kWindowsAcross = 8;       // local contrast is looked at in windows of this share
constexpr double kLeastContrast = 0.2;  // of the contrast of the whole view
constexpr double kFoot = 0.2;           // of the local contrast: below it is background
constexpr int kLeastArea = 9;
constexpr double kLargestAreaShare = 0.02;
constexpr double kLargestAspect = 3;
constexpr double kLeastFilling = 0.5;  // of the bounding box; a disk has 0.785

// Each pixel between the darkest (0) and brightest (1) of its surroundings; 0 where there is little
// contrast.
cv::Mat1f LocalLevel(const Image<double>& view, bool bright) {
  const auto [width, height] = view.size();
  cv::Mat1f light(height, width);
  std::copy(view.pixels().begin(), view.pixels().end(), light.begin());
  if (!bright) light = -light;
  cv::Mat1f smooth;
  cv::GaussianBlur(light, smooth, {5, 5}, 1);
  const int window = std::max(9, std::max(width, height) / kWindowsAcross | 1);
  const cv::Mat box = cv::getStructuringElement(cv::MORPH_RECT, {window, window});
  cv::Mat1f low;
  cv::Mat1f high;
  cv::erode(smooth, low, box);
  cv::dilate(smooth, high, box);
  double least = 0;
  double most = 0;
  cv::minMaxLoc(high - low, &least, &most);
  cv::Mat1f level(height, width, 0.0F);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const float contrast = high(y, x) - low(y, x);
      if (contrast > kLeastContrast * most) level(y, x) = (light(y, x) - low(y, x)) / contrast;
    }
  }
  return level;
}

PixelPoint Centroid(const cv::Mat1f& level, const cv::Rect& box) {
  double sum = 0;
  double x_sum = 0;
  double y_sum = 0;
  for (int y = box.y; y < box.y + box.height; ++y) {
    for (int x = box.x; x < box.x + box.width; ++x) {
      const double weight = std::max(level(y, x) - kFoot, 0.0);
      sum += weight;
      x_sum += weight * x;
      y_sum += weight * y;
    }
  }
  return {x_sum / sum, y_sum / sum};
}

}  // namespace

std::vector<PixelPoint> FindSpots(const Image<double>& view, bool bright) {
  const cv::Mat1f level = LocalLevel(view, bright);
  cv::Mat1f smooth;
  cv::GaussianBlur(level, smooth, {5, 5}, 1);
  const cv::Mat above = smooth > 0.5;
  cv::Mat1i labels;
  cv::Mat1i figures;
  cv::Mat1d centres;
  const int count = cv::connectedComponentsWithStats(above, labels, figures, centres, 8);
  const cv::Rect whole(0, 0, level.cols, level.rows);
  std::vector<PixelPoint> spots;
  for (int i = 1; i < count; ++i) {
    const cv::Rect box(figures(i, cv::CC_STAT_LEFT), figures(i, cv::CC_STAT_TOP),
                       figures(i, cv::CC_STAT_WIDTH), figures(i, cv::CC_STAT_HEIGHT));
    const int area = figures(i, cv::CC_STAT_AREA);
    const cv::Rect around(box.x - 2, box.y - 2, box.width + 4, box.height + 4);
    const double aspect =
        static_cast<double>(std::max(box.width, box.height)) / std::min(box.width, box.height);
    if (area < kLeastArea || area > kLargestAreaShare * whole.area() || aspect > kLargestAspect ||
        area < kLeastFilling * box.area() || (around & whole) != around) {
      continue;
    }
    spots.push_back(Centroid(level, around));
  }
  return spots;
}

}  // namespace eyebox::optics
