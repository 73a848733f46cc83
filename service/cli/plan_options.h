// What a plan is made of, on the command line.
#ifndef EYEBOX_SERVICE_CLI_PLAN_OPTIONS_H_
#define EYEBOX_SERVICE_CLI_PLAN_OPTIONS_H_

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <vector>

#include "capture/plan.h"

namespace eyebox::service::cli {

// `plan` holds the defaults and must outlive the parsing. Returns the options, to see which of them
// were given.
std::vector<CLI::Option*> BindPlan(CLI::App& command, capture::PlanOptions& plan);

}  // namespace eyebox::service::cli

#endif  // EYEBOX_SERVICE_CLI_PLAN_OPTIONS_H_
