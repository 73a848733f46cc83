// What must hold before anything is drawn.
#ifndef EYEBOX_SERVICE_REPORT_VALIDATE_H_
#define EYEBOX_SERVICE_REPORT_VALIDATE_H_

#include "absl/status/status.h"
#include "service/report/report.h"

namespace eyebox::service::report {

// Errors: InvalidArgument naming the figure or row; those that RenderReport promises.
absl::Status Validate(const ReportInput& input);

}  // namespace eyebox::service::report

#endif  // EYEBOX_SERVICE_REPORT_VALIDATE_H_
