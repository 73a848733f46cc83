#include <cstdio>
#include <string>

#include "capture/base/status.h"
#include "service/cli/command.h"
#include "service/cli/terminal.h"
#include "service/compare_renderers.h"

namespace eyebox::service::cli {
namespace {

struct Options {
  KnotsRequest request;
  std::string sweep;
  std::string sweep_out;
  bool json = false;
};

void PrintKnots(const v1::KnotsResult& result) {
  std::printf("%5s %12s %12s %10s %12s %12s %10s\n", "entry", "peak u", "fitted u", "+-",
              "analytic u", "published u", "an/pub-1");
  for (const v1::TableKnot& knot : result.knots()) {
    if (!knot.found()) {
      std::printf("%5d never matters: %s; on the axis it lies at u = %.4g\n", knot.entry(),
                  knot.reason().c_str(), knot.u_analytic());
      continue;
    }
    std::printf("%5d %12.6g %12.6g %10.2g %12.6g", knot.entry(), knot.u_at_peak(), knot.u_fitted(),
                knot.u_fitted_sigma(), knot.u_analytic());
    if (knot.u_published() > 0) {
      std::printf(" %12.6g %+9.2f%%", knot.u_published(), 100 * knot.analytic_over_published());
    }
    std::printf("\n");
  }
  std::printf("u = 0 lands at entry %.3f counted from 0: the entries before it are never read\n",
              result.entry_of_black());
  if (result.analytic_over_published_max() > 0) {
    std::printf("analytic against published knots, from the 4th on: worst %.2f %%, mean %+.2f %%\n",
                100 * result.analytic_over_published_max(),
                100 * result.analytic_over_published_mean());
  }
}

void PrintHypotheses(const v1::KnotsResult& result) {
  std::printf("\nmedian |predicted - stored| in 1/255, each row predicted by a fit without it\n");
  std::printf("%-36s %17s %17s %7s %21s ", "hypothesis", "c", "floor", "mean", "bias r, g, b");
  for (const v1::RenderError& set : result.hypotheses(0).held_out()) {
    std::printf(" %s", set.set().c_str());
  }
  std::printf("\n");
  for (const v1::RenderHypothesis& hypothesis : result.hypotheses()) {
    const v1::Parameter& scale = hypothesis.parameters(0);
    const v1::Parameter& floor = hypothesis.parameters(1);
    std::printf("%-36s %.4f +- %.4f  %.5f +- %.5f %.3f  %+.2f  %+.2f  %+.2f  ",
                hypothesis.name().c_str(), scale.value(), scale.sigma(), floor.value(),
                floor.sigma(), hypothesis.mean_held_out_levels(), hypothesis.bias_levels(0),
                hypothesis.bias_levels(1), hypothesis.bias_levels(2));
    for (const v1::RenderError& set : hypothesis.held_out()) {
      std::printf(" %.3f", set.median_levels());
    }
    std::printf("\n");
  }
  std::printf("best: %s\n", result.best_hypothesis().c_str());
}

absl::Status Run(const Options& options) {
  KnotsRequest request = options.request;
  request.sweep = options.sweep;
  request.sweep_out = options.sweep_out;
  if (request.sweep.empty() && !request.simulates && request.rows.empty()) {
    return BadInput("knots", "nothing to look at", "give a sweep, --simulate or --rows");
  }
  EYEBOX_ASSIGN_OR_RETURN(const v1::KnotsResult result, CompareRenderers(request));
  PrintWarnings(result.warnings());
  if (options.json) return PrintJson(result);
  if (result.knots_size() > 0) PrintKnots(result);
  if (result.hypotheses_size() > 0) PrintHypotheses(result);
  return absl::OkStatus();
}

}  // namespace

void AddKnots(CLI::App& app, Work& work) {
  AddCommand<Options>(
      app, work, "knots",
      "Find where the knots of a renderer's table lie, and which model predicts rendered rows.",
      "eyebox knots sweep.csv\n  eyebox knots --simulate\n"
      "  eyebox knots --rows unlit,unlit.csv --rows lambertian,lit.csv,lut.cube",
      [](CLI::App& command, Options& options) {
        KnotsRequest& request = options.request;
        auto* sweep = command.add_option(
            "sweep", options.sweep,
            "Columns cube,u,t: which entry of the delta cube is 1 (from 1), rendered value, "
            "tonemapped value s(v)");
        auto* simulate = command.add_flag("--simulate", request.simulates,
                                          "Sweep a renderer that samples in LogC instead");
        simulate->excludes(sweep);
        command
            .add_flag("--packed-buffers", request.packed_buffers,
                      "The simulated one stores R11G11B10, truncated")
            ->needs(simulate);
        command.add_option("--sweep-out", options.sweep_out, "Write the simulated sweep there")
            ->needs(simulate);
        command.add_option("--size", request.size, "Entries an axis of the delta cubes")
            ->check(CLI::Range(4, 129))
            ->capture_default_str();
        command.add_option("--rows", request.rows,
                           "MATERIAL,FILE[,CUBE], any number: rows as for `eyebox predict`, with "
                           "v; models are fitted to all of them together and compared by "
                           "held-out error");
        command.add_option("--folds", request.folds, "Folds of the cross-validation")
            ->check(CLI::Range(2, 100))
            ->capture_default_str();
        command.add_flag("--json", options.json, "Print the result as JSON on stdout");
      },
      Run);
}

}  // namespace eyebox::service::cli
