// A drawing of a page as a file by itself.
#ifndef EYEBOX_SERVICE_REPORT_ALONE_H_
#define EYEBOX_SERVICE_REPORT_ALONE_H_

#include <string>

namespace eyebox::service::report {

// `svg` as Svg::Finish() gives it, with the page's style sheet and a white ground.
std::string AloneInFile(std::string svg);

}  // namespace eyebox::service::report

#endif  // EYEBOX_SERVICE_REPORT_ALONE_H_
