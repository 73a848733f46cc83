// A drawing as inline SVG, elements in the order in which they are added. Lengths in SVG units
// (CSS pixels at full size), origin at the upper left.
#ifndef EYEBOX_SERVICE_REPORT_SVG_H_
#define EYEBOX_SERVICE_REPORT_SVG_H_

#include <string>
#include <string_view>
#include <vector>

#include "service/report/axis.h"

namespace eyebox::service::report {

struct Point {
  double x = 0;
  double y = 0;
};

struct Segment {
  Point from;
  Point to;
};

enum class Anchor { kStart, kMiddle, kEnd };

class Svg {
 public:
  // `title` is read aloud instead of the drawing. Classes are those of the page's style sheet.
  Svg(double width, double height, std::string_view title);

  void Line(Segment line, std::string_view css_class);
  void Polyline(const std::vector<Point>& points, std::string_view css_class);
  void Segments(const std::vector<Segment>& segments, std::string_view css_class);
  void Circle(Point centre, double radius, std::string_view css_class);
  void Rectangle(Point corner, double width, double height, std::string_view attributes);
  void Text(Point at, std::string_view text, Anchor anchor, std::string_view css_class);
  void TextUpwards(Point at, std::string_view text, std::string_view css_class);
  // `png` holds the bytes of a PNG file; `smooth` interpolates between its pixels.
  void Picture(Point corner, double width, double height, std::string_view png, bool smooth);

  // What follows is hidden outside the rectangle. `id` is unique on the page.
  void BeginClip(std::string_view id, Point corner, double width, double height);
  void EndClip();

  std::string Finish() &&;

 private:
  std::string text_;
};

// A panel of a figure: the frame, its ticks and labels; what is drawn inside is the caller's.
struct Panel {
  Axis x;               // from left to right
  Axis y;               // from bottom to top
  std::string x_label;  // empty: neither label nor tick labels (the panel below has them)
  std::string y_label;

  double left() const { return x.from; }
  double top() const { return y.to; }
  double width() const { return x.to - x.from; }
  double height() const { return y.from - y.to; }
  Point At(double x_value, double y_value) const {
    return {x.Position(x_value), y.Position(y_value)};
  }
};

void DrawGrid(Svg& svg, const Panel& panel);
void DrawFrame(Svg& svg, const Panel& panel);

}  // namespace eyebox::service::report

#endif  // EYEBOX_SERVICE_REPORT_SVG_H_
