// Filling result messages.
#ifndef EYEBOX_SERVICE_RESULTS_PARAMETER_H_
#define EYEBOX_SERVICE_RESULTS_PARAMETER_H_

#include <google/protobuf/repeated_ptr_field.h>

#include <string>
#include <string_view>
#include <vector>

#include "eyebox/v1/results.pb.h"

namespace eyebox::service {

inline void AddParameter(google::protobuf::RepeatedPtrField<v1::Parameter>& parameters,
                         std::string_view name, double value, double sigma, std::string_view unit) {
  v1::Parameter& parameter = *parameters.Add();
  parameter.set_name(std::string(name));
  parameter.set_value(value);
  parameter.set_sigma(sigma);
  parameter.set_unit(std::string(unit));
}

inline void AddAll(google::protobuf::RepeatedPtrField<std::string>& target,
                   const std::vector<std::string>& lines) {
  target.Add(lines.begin(), lines.end());
}

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_RESULTS_PARAMETER_H_
