// What a person sees of a colour fit and of a three-dimensional table.
#ifndef EYEBOX_SERVICE_CLI_COLOUR_OUTPUT_H_
#define EYEBOX_SERVICE_CLI_COLOUR_OUTPUT_H_

#include "eyebox/v1/color.pb.h"

namespace eyebox::service::cli {

// Model, errors, verdicts and parameters on stdout.
void PrintColourFit(const v1::ColourResult& result);
// White, ramps, interior and the count of entries that cannot be shown, on stdout.
void PrintColourCertificate(const v1::ColourCubeResult& cube);

}  // namespace eyebox::service::cli

#endif  // EYEBOX_SERVICE_CLI_COLOUR_OUTPUT_H_
