// One rendered patch: a plane under a directional and an ambient light (HDRP model, section 7.1).
#ifndef EYEBOX_FIT_RENDERER_SCENE_ROW_H_
#define EYEBOX_FIT_RENDERER_SCENE_ROW_H_

#include <array>
#include <filesystem>
#include <optional>
#include <vector>

#include "absl/status/statusor.h"
#include "capture/base/csv.h"
#include "optics/render/rgb.h"

namespace eyebox::fit {

enum class RowMaterial { kUnlit, kLambertian };

// Names of the document (eq 2) and their columns. An unlit material needs m alone.
struct SceneRow {
  double exposure_stops = 0;           // e
  optics::Rgb material = {};           // m_r, m_g, m_b in [0, 1]
  double facing = 0;                   // max(n.l, 0)
  double directional_intensity = 0;    // i_d
  optics::Rgb directional_color = {};  // d_r, d_g, d_b, at least 0
  double ambient_intensity = 0;        // i_a
  optics::Rgb ambient_color = {};      // a_r, a_g, a_b, at least 0
  std::optional<optics::Rgb> stored;   // v_r, v_g, v_b in [0, 1]: what the framebuffer held
};

// Reads m, and for kLambertian also e, n (n_x, n_y, n_z), l, i_d, d, i_a, a; v where all three
// columns are there. Other columns are left alone. Normal and light direction must be unit vectors
// to 1e-3. Errors: InvalidArgument naming file, line and column (absent, not a number, out of
// range).
absl::StatusOr<std::vector<SceneRow>> SceneRowsOf(const CsvTable& table, RowMaterial material);
absl::StatusOr<std::vector<SceneRow>> ReadSceneRows(const std::filesystem::path& file,
                                                    RowMaterial material);

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_RENDERER_SCENE_ROW_H_
