// Figures of contrast and glare as lines of text.
#ifndef EYEBOX_SERVICE_CLI_GLARE_OUTPUT_H_
#define EYEBOX_SERVICE_CLI_GLARE_OUTPUT_H_

#include "eyebox/v1/scatter.pb.h"

namespace eyebox::service::cli {

void PrintGlareFigures(const google::protobuf::RepeatedPtrField<v1::GlareFigure>& figures);

}  // namespace eyebox::service::cli

#endif  // EYEBOX_SERVICE_CLI_GLARE_OUTPUT_H_
