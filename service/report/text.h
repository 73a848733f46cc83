// Text that goes into the report: escaped, and numbers as a person writes them.
#ifndef EYEBOX_SERVICE_REPORT_TEXT_H_
#define EYEBOX_SERVICE_REPORT_TEXT_H_

#include <string>
#include <string_view>

namespace eyebox::service::report {

// Safe in HTML and SVG, as content and within quotes; control characters become U+FFFD.
std::string Escape(std::string_view text);

// "g", "L (cd/m²)": `quantity` with its unit; without it where that is "1" or empty.
std::string WithUnit(std::string_view quantity, std::string_view unit);

// Plain decimals with a true minus sign: Decimal(-0.5, 2) is "−0.50".
std::string Decimal(double value, int decimals);

}  // namespace eyebox::service::report

#endif  // EYEBOX_SERVICE_REPORT_TEXT_H_
