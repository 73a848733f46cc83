// What the report shows of a run.
#ifndef EYEBOX_SERVICE_RESULTS_REPORT_INPUT_H_
#define EYEBOX_SERVICE_RESULTS_REPORT_INPUT_H_

#include <optional>
#include <vector>

#include "capture/recording/header.h"
#include "eyebox/v1/results.pb.h"
#include "fit/cube/design_table.h"
#include "optics/geometry/entrance_pupil.h"
#include "optics/uniformity/uniformity_map.h"
#include "service/report/report.h"

namespace eyebox::service {

struct RunFindings {
  const capture::RecordingHeader& header;
  const v1::RunResult& result;
  const optics::UniformityMap& map;
  const Image<float>& smooth_g;  // map.smooth, drawn
  const fit::Activation& activation;
  const std::vector<fit::TableDesign>& tables;
  // Where it was calibrated; else that of the header.
  const std::optional<optics::ViewGeometry>& geometry;
};

// Borrows the maps of `findings`.
report::ReportInput MakeReportInput(const RunFindings& findings);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_RESULTS_REPORT_INPUT_H_
