#include "service/report/svg.h"

#include <fmt/format.h>

#include <iterator>
#include <utility>

#include "absl/strings/escaping.h"
#include "service/report/text.h"

namespace eyebox::service::report {
namespace {

constexpr double kTickLength = 5;

std::string_view AnchorName(Anchor anchor) {
  switch (anchor) {
    case Anchor::kStart:
      return "start";
    case Anchor::kMiddle:
      return "middle";
    case Anchor::kEnd:
      return "end";
  }
  return "start";
}

}  // namespace

Svg::Svg(double width, double height, std::string_view title)
    : text_(fmt::format("<svg viewBox=\"0 0 {0:g} {1:g}\" width=\"{0:g}\" height=\"{1:g}\" "
                        "role=\"img\" aria-label=\"{2}\">\n",
                        width, height, Escape(title))) {}

void Svg::Line(Segment line, std::string_view css_class) {
  text_ +=
      fmt::format("<line class=\"{}\" x1=\"{:.2f}\" y1=\"{:.2f}\" x2=\"{:.2f}\" y2=\"{:.2f}\"/>\n",
                  css_class, line.from.x, line.from.y, line.to.x, line.to.y);
}

void Svg::Polyline(const std::vector<Point>& points, std::string_view css_class) {
  text_ += fmt::format("<polyline class=\"{}\" points=\"", css_class);
  for (const Point& p : points) {
    fmt::format_to(std::back_inserter(text_), "{:.2f},{:.2f} ", p.x, p.y);
  }
  text_ += "\"/>\n";
}

void Svg::Segments(const std::vector<Segment>& segments, std::string_view css_class) {
  text_ += fmt::format("<path class=\"{}\" d=\"", css_class);
  for (const Segment& s : segments) {
    fmt::format_to(std::back_inserter(text_), "M{:.1f} {:.1f}L{:.1f} {:.1f}", s.from.x, s.from.y,
                   s.to.x, s.to.y);
  }
  text_ += "\"/>\n";
}

void Svg::Circle(Point centre, double radius, std::string_view css_class) {
  text_ += fmt::format("<circle class=\"{}\" cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"{:g}\"/>\n", css_class,
                       centre.x, centre.y, radius);
}

void Svg::Rectangle(Point corner, double width, double height, std::string_view attributes) {
  text_ += fmt::format("<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" {}/>\n",
                       corner.x, corner.y, width, height, attributes);
}

void Svg::Text(Point at, std::string_view text, Anchor anchor, std::string_view css_class) {
  if (text.empty()) return;
  text_ +=
      fmt::format("<text class=\"{}\" x=\"{:.2f}\" y=\"{:.2f}\" text-anchor=\"{}\">{}</text>\n",
                  css_class, at.x, at.y, AnchorName(anchor), Escape(text));
}

void Svg::TextUpwards(Point at, std::string_view text, std::string_view css_class) {
  text_ += fmt::format(
      "<text class=\"{0}\" transform=\"translate({1:.2f} {2:.2f}) rotate(-90)\" "
      "text-anchor=\"middle\">{3}</text>\n",
      css_class, at.x, at.y, Escape(text));
}

void Svg::Picture(Point corner, double width, double height, std::string_view png, bool smooth) {
  const std::string base64 = absl::Base64Escape({png.data(), png.size()});
  text_ += fmt::format(
      "<image x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" "
      "preserveAspectRatio=\"none\" style=\"image-rendering:{}\" "
      "href=\"data:image/png;base64,{}\"/>\n",
      corner.x, corner.y, width, height, smooth ? "auto" : "pixelated", base64);
}

void Svg::BeginClip(std::string_view id, Point corner, double width, double height) {
  text_ += fmt::format("<clipPath id=\"{}\">", id);
  Rectangle(corner, width, height, "");
  text_ += fmt::format("</clipPath><g clip-path=\"url(#{})\">\n", id);
}

void Svg::EndClip() { text_ += "</g>\n"; }

std::string Svg::Finish() && { return std::move(text_) + "</svg>\n"; }

void DrawGrid(Svg& svg, const Panel& panel) {
  std::vector<Segment> lines;
  for (const Tick& tick : panel.x.ticks) {
    const double x = panel.x.Position(tick.value);
    if (!tick.label.empty()) lines.push_back({{x, panel.y.from}, {x, panel.y.to}});
  }
  for (const Tick& tick : panel.y.ticks) {
    const double y = panel.y.Position(tick.value);
    if (!tick.label.empty()) lines.push_back({{panel.x.from, y}, {panel.x.to, y}});
  }
  svg.Segments(lines, "grid");
}

void DrawFrame(Svg& svg, const Panel& panel) {
  svg.Rectangle({panel.left(), panel.top()}, panel.width(), panel.height(), "class=\"frame\"");
  const double bottom = panel.y.from;
  for (const Tick& tick : panel.x.ticks) {
    const double x = panel.x.Position(tick.value);
    const double length = tick.label.empty() ? kTickLength / 2 : kTickLength;
    svg.Line({{x, bottom}, {x, bottom + length}}, "tick");
    if (!panel.x_label.empty()) svg.Text({x, bottom + 18}, tick.label, Anchor::kMiddle, "number");
  }
  for (const Tick& tick : panel.y.ticks) {
    const double y = panel.y.Position(tick.value);
    const double length = tick.label.empty() ? kTickLength / 2 : kTickLength;
    svg.Line({{panel.left() - length, y}, {panel.left(), y}}, "tick");
    svg.Text({panel.left() - 8, y + 4}, tick.label, Anchor::kEnd, "number");
  }
  const double middle = panel.left() + panel.width() / 2;
  svg.Text({middle, bottom + 38}, panel.x_label, Anchor::kMiddle, "label");
  svg.TextUpwards({panel.left() - 52, panel.top() + panel.height() / 2}, panel.y_label, "label");
}

}  // namespace eyebox::service::report
