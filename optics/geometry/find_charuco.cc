#include "optics/geometry/find_charuco.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "Eigen/Core"
#include "Eigen/QR"
#include "absl/strings/str_cat.h"
#include "capture/base/status.h"
#include "opencv2/aruco/charuco.hpp"
#include "opencv2/core.hpp"

namespace eyebox::optics {
namespace {

constexpr size_t kFewestCorners = 6;
constexpr double kLargestMisfit = 0.15;  // rms in squares of what lies smoothly on the board

struct Markers {
  std::vector<std::vector<cv::Point2f>> corners;
  std::vector<int> ids;
};

absl::Status Check(const CharucoBoard& board) {
  if (board.columns < 3 || board.rows < 3 || board.columns * board.rows > 500) {
    return BadInput("ChArUco board", absl::StrCat(board.columns, " x ", board.rows, " squares"),
                    "give at least 3 columns and rows, and at most 500 squares");
  }
  if (!(board.marker_mm > 0 && board.marker_mm < board.square_mm) ||
      !std::isfinite(board.square_mm)) {
    return BadInput(
        "ChArUco board",
        absl::StrCat("markers of ", board.marker_mm, " mm in squares of ", board.square_mm, " mm"),
        "give markers smaller than the squares, both above 0");
  }
  if (board.marker_bits < 4 || board.marker_bits > 6) {
    return BadInput("ChArUco board", absl::StrCat(board.marker_bits, " bits"),
                    "give 4, 5 or 6: a dictionary DICT_4X4_250, DICT_5X5_250 or DICT_6X6_250");
  }
  return absl::OkStatus();
}

cv::Ptr<cv::aruco::CharucoBoard> Create(const CharucoBoard& board) {
  const int name = board.marker_bits == 4   ? cv::aruco::DICT_4X4_250
                   : board.marker_bits == 5 ? cv::aruco::DICT_5X5_250
                                            : cv::aruco::DICT_6X6_250;
  return cv::aruco::CharucoBoard::create(
      board.columns, board.rows, static_cast<float>(board.square_mm),
      static_cast<float>(board.marker_mm), cv::aruco::getPredefinedDictionary(name));
}

// The detector wants 8 bits: all of the range that is there.
cv::Mat1b Stretched(const Image<double>& view) {
  const auto range = std::ranges::minmax(view.pixels());
  const double low = range.min;
  const double high = range.max;
  const double scale = high > low ? 255 / (high - low) : 0;
  cv::Mat1b grey(view.size().height_px, view.size().width_px);
  std::ranges::transform(view.pixels(), grey.begin(), [&](double value) {
    return static_cast<uint8_t>(std::lround((value - low) * scale));
  });
  return grey;
}

// rms distance, in squares, of marker corners from a polynomial of their place on the board: a lens
// bends a board smoothly, another numbering of the markers scatters them.
double Misfit(const Markers& markers, const cv::aruco::CharucoBoard& board) {
  const auto count = static_cast<Eigen::Index>(4 * markers.ids.size());
  const int order = count < 12 ? 1 : count < 40 ? 2 : 3;
  const double square = board.getSquareLength();
  Eigen::MatrixXd design(count, (order + 1) * (order + 2) / 2);
  Eigen::MatrixXd image(count, 2);
  for (Eigen::Index row = 0; row < count; ++row) {
    const auto marker = static_cast<size_t>(row / 4);
    const auto corner = static_cast<size_t>(row % 4);
    const cv::Point3f& place = board.objPoints[static_cast<size_t>(markers.ids[marker])][corner];
    const cv::Point2f& seen = markers.corners[marker][corner];
    image.row(row) << seen.x, seen.y;
    Eigen::Index column = 0;
    for (int i = 0; i <= order; ++i) {
      for (int j = 0; i + j <= order; ++j) {
        design(row, column++) = std::pow(place.x / square, i) * std::pow(place.y / square, j);
      }
    }
  }
  const Eigen::MatrixXd fit = design.colPivHouseholderQr().solve(image);
  double side_px = 0;
  for (const auto& corners : markers.corners) {
    side_px += cv::norm(corners[0] - corners[1]) / static_cast<double>(markers.corners.size());
  }
  const double square_px = side_px * square / board.getMarkerLength();
  return std::sqrt((design * fit - image).squaredNorm() / static_cast<double>(count)) / square_px;
}

// Clutter and noise are taken for a marker now and then, of any number.
void DropForeign(size_t count, Markers& markers) {
  Markers kept;
  for (size_t i = 0; i < markers.ids.size(); ++i) {
    if (markers.ids[i] >= static_cast<int>(count)) continue;
    kept.ids.push_back(markers.ids[i]);
    kept.corners.push_back(markers.corners[i]);
  }
  markers = std::move(kept);
}

absl::StatusOr<Markers> FindMarkers(const cv::Mat1b& grey,
                                    const cv::Ptr<cv::aruco::CharucoBoard>& board,
                                    std::string_view source) {
  Markers markers;
  auto settings = cv::aruco::DetectorParameters::create();
  settings->cornerRefinementMethod = cv::aruco::CORNER_REFINE_NONE;  // of the corners of squares
  cv::aruco::detectMarkers(grey, board->dictionary, markers.corners, markers.ids, settings);
  if (markers.ids.empty()) {
    return Rejected(source, "shows no marker of the board's dictionary",
                    "give the marker bits of the board, and a sharp view of it");
  }
  const auto size = board->getChessboardSize();
  const std::string named = absl::StrCat(size.width, " x ", size.height, " squares");
  const int largest = *std::ranges::max_element(markers.ids);
  const size_t found = markers.ids.size();
  DropForeign(board->ids.size(), markers);
  if (2 * markers.ids.size() <= found) {
    return Rejected(source,
                    absl::StrCat("shows marker ", largest, ", a board of ", named,
                                 " ends with marker ", board->ids.size() - 1),
                    "give the columns and rows of squares of the board");
  }
  if (const double misfit = Misfit(markers, *board); misfit > kLargestMisfit) {
    return Rejected(source, absl::StrCat("its markers do not lie as on a board of ", named),
                    "give the columns and rows of squares of the board");
  }
  return markers;
}

absl::StatusOr<ViewPoints> Find(const Image<double>& view, const CharucoBoard& board,
                                std::string_view source) {
  const auto created = Create(board);
  const cv::Mat1b grey = Stretched(view);
  EYEBOX_ASSIGN_OR_RETURN(const Markers markers, FindMarkers(grey, created, source));
  std::vector<cv::Point2f> corners;
  std::vector<int> ids;
  cv::aruco::interpolateCornersCharuco(markers.corners, markers.ids, grey, created, corners, ids);
  if (corners.size() < kFewestCorners) {
    return Rejected(source, absl::StrCat("shows ", corners.size(), " corners of the board"),
                    absl::StrCat("a view needs ", kFewestCorners));
  }
  ViewPoints points{std::string(source), {}};
  for (size_t i = 0; i < corners.size(); ++i) {
    const cv::Point3f& place = created->chessboardCorners[static_cast<size_t>(ids[i])];
    points.points.push_back(
        {.x_mm = place.x, .y_mm = place.y, .pixel = {corners[i].x, corners[i].y}});
  }
  return points;
}

}  // namespace

absl::StatusOr<ViewPoints> FindCharuco(const Image<double>& view, const CharucoBoard& board,
                                       std::string_view source) {
  EYEBOX_RETURN_IF_ERROR(Check(board));
  try {
    return Find(view, board, source);
  } catch (const cv::Exception& error) {
    return Rejected(source, absl::StrCat("OpenCV gave up on it (", error.err, ")"),
                    "take another view");
  }
}

absl::StatusOr<Image<double>> DrawCharuco(const CharucoBoard& board, int square_px) {
  EYEBOX_RETURN_IF_ERROR(Check(board));
  if (square_px < 8 || square_px > 1000) {
    return BadInput("ChArUco board", absl::StrCat(square_px, " px a square"), "give 8 to 1000");
  }
  const ImageSize size{board.columns * square_px, board.rows * square_px};
  cv::Mat1b drawn;
  try {
    Create(board)->draw({size.width_px, size.height_px}, drawn);
  } catch (const cv::Exception& error) {
    return BadInput("ChArUco board", error.err, "give more pixels a square");
  }
  Image<double> image(size);
  std::copy(drawn.begin(), drawn.end(), image.pixels().begin());
  return image;
}

}  // namespace eyebox::optics
