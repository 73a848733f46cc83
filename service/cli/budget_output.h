// An uncertainty budget for a person.
#ifndef EYEBOX_SERVICE_CLI_BUDGET_OUTPUT_H_
#define EYEBOX_SERVICE_CLI_BUDGET_OUTPUT_H_

#include "eyebox/v1/budget.pb.h"

namespace eyebox::service::cli {

// The uncertainties of each rendered value, then the terms of a middle one by share.
void PrintBudget(const v1::BudgetResult& budget);

}  // namespace eyebox::service::cli

#endif  // EYEBOX_SERVICE_CLI_BUDGET_OUTPUT_H_
