#include "service/cli/budget_output.h"

#include <cmath>
#include <cstdio>

namespace eyebox::service::cli {
namespace {

constexpr double kMiddleU = 0.2;
constexpr double kLeastShare = 0.0005;  // shown as 0.1 %

const v1::BudgetPoint& MiddlePoint(const v1::BudgetResult& budget) {
  const v1::BudgetPoint* middle = &budget.points(0);
  for (const v1::BudgetPoint& point : budget.points()) {
    const double distance = std::abs(std::log(point.u() / kMiddleU));
    if (distance < std::abs(std::log(middle->u() / kMiddleU))) middle = &point;
  }
  return *middle;
}

}  // namespace

void PrintBudget(const v1::BudgetResult& budget) {
  std::printf("\n  %8s %10s %14s %14s %16s\n", "u", "drive", "sigma / (1/255)", "proportional",
              "luminance");
  for (const v1::BudgetPoint& point : budget.points()) {
    std::printf("  %8g %10.5f %15.3f %12.3f %% %14.3f %%\n", point.u(), point.drive(),
                255 * point.drive_sigma(), 100 * point.departure_sigma(),
                100 * point.luminance_sigma() / point.luminance());
  }
  if (budget.points().empty()) return;
  const v1::BudgetPoint& middle = MiddlePoint(budget);
  std::printf("\n  Shares of the variance at u = %g\n  %-18s %10s %14s %12s\n", middle.u(), "term",
              "drive", "proportional", "luminance");
  for (const v1::BudgetTerm& term : middle.terms()) {
    if (std::fmax(term.drive_share(), term.luminance_share()) < kLeastShare) continue;
    std::printf("  %-18s %8.1f %% %12.1f %% %10.1f %%\n", term.name().c_str(),
                100 * term.drive_share(), 100 * term.departure_share(),
                100 * term.luminance_share());
  }
  if (budget.trials() > 0) {
    std::printf("  Checked by %lld random trials: %s\n", static_cast<long long>(budget.trials()),
                budget.check().c_str());
  }
}

}  // namespace eyebox::service::cli
