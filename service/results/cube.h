// A designed table as a result message.
#ifndef EYEBOX_SERVICE_RESULTS_CUBE_H_
#define EYEBOX_SERVICE_RESULTS_CUBE_H_

#include <string_view>

#include "eyebox/v1/results.pb.h"
#include "fit/cube/design_table.h"

namespace eyebox::service {

// `bytes` is what the file of that name holds.
v1::CubeResult DescribeCube(const fit::TableDesign& design, const v1::ActivationResult& activation,
                            std::string_view file, std::string_view bytes);

// Adds what the table leaves after a storage model.
void AddStored(const fit::StoredCertificate& stored, v1::CubeResult& result);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_RESULTS_CUBE_H_
