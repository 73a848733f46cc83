#include "service/report/report.h"

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <utility>

#include "capture/base/status.h"
#include "capture/base/version.h"
#include "service/report/figures.h"
#include "service/report/style.h"
#include "service/report/text.h"
#include "service/report/validate.h"

namespace eyebox::service::report {
namespace {

// The page as it grows, with the number of figures so far.
class Page {
 public:
  explicit Page(std::string_view title) {
    text_ = fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width\">\n<title>{}</title>\n"
        "<style>{}</style>\n</head>\n<body>\n",
        Escape(title), kStyle);
  }

  void Add(std::string_view markup) { text_ += markup; }
  // `tag` without brackets, `content` is escaped.
  void AddText(std::string_view tag, std::string_view content) {
    text_ += fmt::format("<{0}>{1}</{0}>\n", tag, Escape(content));
  }
  void AddFigure(std::string_view svg, std::string_view title, std::string_view caption) {
    text_ += fmt::format(
        "<figure>\n{}<figcaption><strong>Figure {}. {}.</strong> {}</figcaption>\n</figure>\n", svg,
        ++figures_, Escape(title), Escape(caption));
  }
  std::string Finish() && {
    return std::move(text_) + fmt::format(
                                  "<footer>Eyebox {}. Uncertainties are standard "
                                  "uncertainties (k = 1).</footer>\n</body>\n</html>\n",
                                  kVersion);
  }

 private:
  std::string text_;
  int figures_ = 0;
};

void AddHead(Page& page, const ReportInput& input) {
  page.AddText("h1", input.title);
  if (!input.summary.empty()) page.AddText("p", input.summary);
  if (!input.key_results.empty()) {
    page.Add("<div class=\"keys\">\n");
    for (const KeyResult& key : input.key_results) {
      page.Add(
          fmt::format("<div class=\"key\"><div class=\"label\">{}</div>"
                      "<div class=\"value\">{}</div><div class=\"note\">{}</div></div>\n",
                      Escape(key.label), Escape(key.value), Escape(key.note)));
    }
    page.Add("</div>\n");
  }
  if (!input.warnings.empty()) {
    page.Add("<div class=\"warnings\"><p>What to know before using these results</p>\n<ul>\n");
    for (const std::string& warning : input.warnings) page.AddText("li", warning);
    page.Add("</ul></div>\n");
  }
  if (!input.facts.empty()) {
    page.AddText("h2", "What was measured");
    page.Add("<dl class=\"facts\">\n");
    for (const Fact& fact : input.facts) {
      page.AddText("dt", fact.label);
      page.AddText("dd", fact.value);
    }
    page.Add("</dl>\n");
  }
}

absl::Status AddMaps(Page& page, const ReportInput& input) {
  if (input.maps.empty()) return absl::OkStatus();
  page.AddText("h2", "Over the field");
  for (size_t i = 0; i < input.maps.size(); ++i) {
    const MapFigure& map = input.maps[i];
    EYEBOX_ASSIGN_OR_RETURN(const std::string svg, DrawMap(map, fmt::format("map-{}", i)));
    page.AddFigure(svg, map.title, map.caption);
  }
  return absl::OkStatus();
}

void AddCertificates(Page& page, const ReportInput& input) {
  if (input.certificates.empty() && input.error_curves.empty()) return;
  page.AddText("h2", "Tables and the error that they leave");
  if (!input.error_curves.empty()) {
    page.AddFigure(
        DrawErrorCurves(input.error_curves, input.certificates, "error-curves"),
        "Relative luminance error against the rendered value u",
        "Shaded: the range that the certificate covers; circled: the largest error in "
        "it. The vertical axis fits that range, so errors below it may leave the frame.");
  }
  if (input.certificates.empty()) return;
  page.Add(
      "<table>\n<tr><th>table</th><th>target</th><th class=\"numeric\">largest error</th>"
      "<th class=\"numeric\">at u</th><th class=\"numeric\">rms error</th>"
      "<th class=\"numeric\">holds for u</th></tr>\n");
  for (const CertificateRow& row : input.certificates) {
    page.Add(
        fmt::format("<tr><td>{}</td><td>{}</td><td class=\"numeric\">{}</td>"
                    "<td class=\"numeric\">{:.4g}</td><td class=\"numeric\">{}</td>"
                    "<td class=\"numeric\">{:.3g} to {:.3g}</td></tr>\n",
                    Escape(row.table), Escape(row.target), Percent(row.max_relative), row.at_u,
                    Percent(row.rms_relative), row.u.minimum, row.u.maximum));
  }
  page.Add("</table>\n");
}

void AddParameters(Page& page, const ReportInput& input) {
  if (input.parameters.empty()) return;
  page.AddText("h2", "Parameters");
  for (const ParameterTable& table : input.parameters) {
    page.AddText("h3", table.title);
    page.Add("<table>\n<tr><th>quantity</th><th>value</th><th>unit</th></tr>\n");
    for (const ParameterRow& row : table.rows) {
      page.Add(fmt::format("<tr><td>{}</td><td>{}{}</td><td>{}</td></tr>\n", Escape(row.name),
                           WithSigma(row.value, row.sigma), row.held ? " (held)" : "",
                           Escape(row.unit == "cd/m2" ? "cd/m²" : row.unit)));
    }
    page.Add("</table>\n");
  }
}

void AddHistory(Page& page, const ReportInput& input) {
  if (input.history.empty()) return;
  page.AddText("h2", "How it was reduced");
  page.Add("<ol class=\"history\">\n");
  for (const std::string& step : input.history) page.AddText("li", step);
  page.Add("</ol>\n");
}

}  // namespace

absl::StatusOr<std::string> RenderReport(const ReportInput& input) {
  EYEBOX_RETURN_IF_ERROR(Validate(input));
  Page page(input.title);
  AddHead(page, input);
  EYEBOX_RETURN_IF_ERROR(AddMaps(page, input));
  if (input.fit) {
    page.AddText("h2", "Activation");
    page.AddFigure(DrawFit(*input.fit), input.fit->title, input.fit->caption);
  }
  AddCertificates(page, input);
  AddParameters(page, input);
  AddHistory(page, input);
  return std::move(page).Finish();
}

}  // namespace eyebox::service::report
