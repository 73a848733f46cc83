// The figures of the report, each an inline SVG. Input has been checked by RenderReport.
#ifndef EYEBOX_SERVICE_REPORT_FIGURES_H_
#define EYEBOX_SERVICE_REPORT_FIGURES_H_

#include <string>
#include <string_view>
#include <vector>

#include "absl/status/statusor.h"
#include "service/report/report.h"

namespace eyebox::service::report {

// The map in viridis with a colour bar, contours and axes in degrees or pixels.
// `id` is unique on the page. Errors: those of EncodePng.
absl::StatusOr<std::string> DrawMap(const MapFigure& map, std::string_view id);

// Luminance against drive with the fit, logarithmic where all is above 0; relative residuals with
// their standard uncertainty below, on the same drive axis.
std::string DrawFit(const FitFigure& fit);

// Relative luminance error against u, logarithmic in u; `certificates` give the range that counts,
// which is shaded and fixes the vertical axis.
std::string DrawErrorCurves(const std::vector<ErrorCurve>& curves,
                            const std::vector<CertificateRow>& certificates, std::string_view id);

}  // namespace eyebox::service::report

#endif  // EYEBOX_SERVICE_REPORT_FIGURES_H_
