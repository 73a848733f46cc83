#include "service/server/store/names.h"

#include <vector>

#include "absl/strings/cord.h"
#include "absl/strings/escaping.h"
#include "absl/strings/str_split.h"
#include "capture/base/status.h"

namespace eyebox::service {
namespace {

constexpr size_t kMaxPartCharacters = 64;
constexpr size_t kMaxQuotedCharacters = 80;
constexpr std::string_view kFieldUrl = "eyebox/field";

bool IsPart(const NameRule& rule, std::string_view part) {
  return !part.empty() && part.size() <= kMaxPartCharacters && part != "." && part != ".." &&
         part.find_first_not_of(rule.characters) == std::string_view::npos;
}

std::string Form(const NameRule& rule) {
  std::string parts =
      "PART, 1 to 64 characters of " +
      std::string(rule.characters == kRigCharacters ? "[a-z0-9-]" : "[A-Za-z0-9_.-]");
  if (rule.max_parts > 1) {
    parts += ", at most " + std::to_string(rule.max_parts) + " of them with / between";
  }
  return "give " + std::string(rule.prefix) + parts;
}

}  // namespace

absl::StatusOr<std::string> CheckName(const NameRule& rule, std::string_view field,
                                      std::string_view name) {
  const auto refusal = [&] {
    return BadField(field, Quoted(name) + " does not name " + std::string(rule.what), Form(rule));
  };
  if (!name.starts_with(rule.prefix)) return refusal();
  const std::string_view rest = name.substr(rule.prefix.size());
  // Bounds the work below, whatever the client sent.
  if (rest.size() > static_cast<size_t>(rule.max_parts) * (kMaxPartCharacters + 1)) {
    return refusal();
  }
  const std::vector<std::string> parts =
      absl::StrSplit(absl::string_view(rest.data(), rest.size()), '/');
  if (parts.size() > static_cast<size_t>(rule.max_parts)) return refusal();
  for (const std::string& part : parts) {
    if (!IsPart(rule, part)) return refusal();
  }
  return std::string(rest);
}

absl::Status BadField(std::string_view field, std::string_view what, std::string_view remedy) {
  return WithField(BadInput(field, what, remedy), field);
}

absl::Status WithField(absl::Status status, std::string_view field) {
  status.SetPayload({kFieldUrl.data(), kFieldUrl.size()}, absl::Cord(std::string(field)));
  return status;
}

std::string FieldOf(const absl::Status& status) {
  const auto payload = status.GetPayload({kFieldUrl.data(), kFieldUrl.size()});
  return payload ? std::string(*payload) : std::string();
}

std::string Quoted(std::string_view text) {
  const std::string_view shown = text.substr(0, kMaxQuotedCharacters);
  return "'" + absl::CHexEscape({shown.data(), shown.size()}) +
         (shown.size() < text.size() ? "...'" : "'");
}

}  // namespace eyebox::service
