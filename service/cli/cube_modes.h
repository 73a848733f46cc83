// What `eyebox cube` does beside designing one table.
#ifndef EYEBOX_SERVICE_CLI_CUBE_MODES_H_
#define EYEBOX_SERVICE_CLI_CUBE_MODES_H_

#include "absl/status/status.h"
#include "service/field_tables.h"
#include "service/probe.h"

namespace eyebox::service::cli {

absl::Status RunProbe(const ProbeRequest& request, bool json);
absl::Status RunFieldTables(const FieldTablesRequest& request, bool json);

}  // namespace eyebox::service::cli

#endif  // EYEBOX_SERVICE_CLI_CUBE_MODES_H_
