#include "fit/cube/cube_text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <string>

#include "absl/strings/str_cat.h"
#include "fit/cube/table_file.h"

namespace eyebox::fit {
namespace {

void AppendNumber(std::string& text, double value) {
  std::array<char, 32> digits;
  const auto [end, error] =
      std::to_chars(digits.data(), digits.data() + digits.size(), static_cast<float>(value));
  text.append(digits.data(), end);
}

void AppendDomain(std::string& text, const Cube3d& cube) {
  const Cube3d usual;
  if (cube.domain_min == usual.domain_min && cube.domain_max == usual.domain_max) return;
  text += "DOMAIN_MIN ";
  AppendTriplet(text, cube.domain_min);
  text += "DOMAIN_MAX ";
  AppendTriplet(text, cube.domain_max);
}

}  // namespace

void AppendTriplet(std::string& text, const std::array<double, 3>& triplet) {
  for (size_t i = 0; i < 3; ++i) {
    AppendNumber(text, triplet[i]);
    text.push_back(i < 2 ? ' ' : '\n');
  }
}

std::string EncodeCube(const Cube3d& cube) {
  std::string text;
  text.reserve(cube.entries.size() * 36 + 256);
  if (!cube.title.empty()) {
    std::string title = cube.title;
    std::ranges::replace_if(
        title, [](char c) { return c == '"' || c == '\n' || c == '\r'; }, ' ');
    absl::StrAppend(&text, "TITLE \"", title, "\"\n");
  }
  absl::StrAppend(&text, "LUT_3D_SIZE ", cube.size, "\n");
  AppendDomain(text, cube);
  for (const auto& entry : cube.entries) AppendTriplet(text, entry);
  return text;
}

}  // namespace eyebox::fit
