#include "service/report/alone.h"

#include <string_view>

#include "service/report/style.h"

namespace eyebox::service::report {

std::string AloneInFile(std::string svg) {
  constexpr std::string_view kOpening = "<svg ";
  svg.insert(svg.find('\n') + 1, "<style>" + std::string(kStyle) +
                                     "</style>\n<rect width=\"100%\" height=\"100%\" "
                                     "fill=\"#fff\"/>\n");
  svg.insert(svg.find(kOpening) + kOpening.size(), "xmlns=\"http://www.w3.org/2000/svg\" ");
  return svg;
}

}  // namespace eyebox::service::report
