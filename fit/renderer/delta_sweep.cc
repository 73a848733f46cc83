#include "fit/renderer/delta_sweep.h"

#include <cmath>
#include <cstddef>
#include <memory>
#include <vector>

#include "capture/base/status.h"
#include "optics/render/render_pipeline.h"
#include "optics/render/srgb.h"

namespace eyebox::fit {
namespace {

optics::RenderPipeline DeltaPipeline(const SweepOptions& options, int cube) {
  std::vector<double> entries(static_cast<size_t>(options.size), 0.0);
  entries[cube - 1] = 1;
  optics::RenderPipeline pipeline;
  if (options.packed_buffers) pipeline.emplace_back(optics::PackedFloatBuffer{});
  pipeline.emplace_back(optics::LogCTable{
      std::make_shared<const optics::ColourTable>(optics::SeparableTable(entries))});
  if (options.packed_buffers) pipeline.emplace_back(optics::PackedFloatBuffer{});
  if (options.rounds_to_8bits) {
    pipeline.emplace_back(optics::EncodeSrgb{});
    pipeline.emplace_back(optics::QuantiseTo8Bits{});
    pipeline.emplace_back(optics::DecodeSrgb{});
  }
  return pipeline;
}

}  // namespace

absl::StatusOr<DeltaSweep> SimulateDeltaSweep(const SweepOptions& options) {
  if (options.size < 4 || options.size > 129) {
    return BadInput("size", "not a table's size", "give 4 to 129");
  }
  if (options.steps < 2 || !(options.u_from > 0) || !(options.u_to > options.u_from)) {
    return BadInput("sweep", "the values of u are no range", "give 2 steps and 0 < from < to");
  }
  DeltaSweep sweep{options.size, {}};
  const double log_range = std::log(options.u_to / options.u_from);
  for (int cube = 1; cube <= options.size; ++cube) {
    const optics::RenderPipeline pipeline = DeltaPipeline(options, cube);
    for (int step = 0; step < options.steps; ++step) {
      const double u = options.u_from * std::exp(log_range * step / (options.steps - 1));
      sweep.readings.push_back({cube, u, optics::RunPipeline(pipeline, {u, u, u})[1]});
    }
  }
  return sweep;
}

}  // namespace eyebox::fit
