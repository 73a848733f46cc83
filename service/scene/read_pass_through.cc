#include <google/protobuf/repeated_field.h>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"
#include "service/scene/read_scene.h"
#include "service/scene/scene_field.h"

namespace eyebox::service {
namespace {

constexpr int kUsualBits = 8;
constexpr int kMostBits = 16;

using Values = google::protobuf::RepeatedField<double>;

absl::Status CheckCount(const Values& values, int count, const SceneField& field) {
  if (values.empty() || values.size() == count) {
    for (const double value : values) {
      EYEBOX_RETURN_IF_ERROR(field.Number(value, kAnyFinite).status());
    }
    return absl::OkStatus();
  }
  return field.Refuse(absl::StrCat("has ", values.size(), " values"),
                      absl::StrCat("give ", count, ", or none"));
}

absl::Status FillMatrix(const Values& values, const SceneField& field, optics::Matrix3& matrix) {
  EYEBOX_RETURN_IF_ERROR(CheckCount(values, 9, field));
  for (int i = 0; i < values.size(); ++i) matrix[i / 3][i % 3] = values[i];
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<MixedReality> ReadPassThrough(const v1::PassThrough& pass_through,
                                             const std::string& where) {
  const SceneField field = {where};
  MixedReality mixed;
  EYEBOX_ASSIGN_OR_RETURN(mixed.camera.ev, field.Of("ev").Number(pass_through.ev(), kAnyFinite));
  EYEBOX_ASSIGN_OR_RETURN(mixed.camera.calibration_constant,
                          field.Of("camera_calibration_constant")
                              .Number(pass_through.camera_calibration_constant(), kAboveZero));
  mixed.bits = pass_through.bits() == 0 ? kUsualBits : pass_through.bits();
  if (mixed.bits < 1 || mixed.bits > kMostBits) {
    return field.Of("bits").Refuse(absl::StrCat("is ", mixed.bits), "it must be from 1 to 16");
  }
  EYEBOX_RETURN_IF_ERROR(
      FillMatrix(pass_through.inverse_ccm(), field.Of("inverse_ccm"), mixed.balance.inverse_ccm));
  EYEBOX_RETURN_IF_ERROR(FillMatrix(pass_through.ccm(), field.Of("ccm"), mixed.balance.ccm));
  const Values& gains = pass_through.white_balance_gains();
  EYEBOX_RETURN_IF_ERROR(CheckCount(gains, 3, field.Of("white_balance_gains")));
  for (int k = 0; k < gains.size(); ++k) mixed.balance.gains[k] = gains[k];
  mixed.match_exposure = pass_through.match_exposure();
  return mixed;
}

}  // namespace eyebox::service
