// What a field stack and its options must fulfil before and after the first pass.
#ifndef EYEBOX_FIT_FIELD_VALIDATE_STACK_H_
#define EYEBOX_FIT_FIELD_VALIDATE_STACK_H_

#include "absl/status/status.h"
#include "fit/field/common_exponent.h"
#include "fit/field/shared_exponent.h"
#include "fit/field/stack_blocks.h"

namespace eyebox::fit {

absl::Status ValidateStack(const FieldStack& stack);
absl::Status ValidateOptions(const FieldStack& stack, const CommonExponentOptions& options);
absl::Status ValidateGammaLimits(double gamma_min, double gamma_max);
absl::Status ValidateMaskedStack(const MaskedStack& stack);
// Errors: InvalidArgument (a valid luminance is not finite: names the first), FailedPrecondition
// (no valid location, the mean luminance does not rise with the drive).
absl::Status ValidateMoments(const FieldStack& stack, const StackMoments& moments);

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_FIELD_VALIDATE_STACK_H_
