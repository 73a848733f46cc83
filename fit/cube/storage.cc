#include "fit/cube/storage.h"

#include <array>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"
#include "optics/render/small_float.h"

namespace eyebox::fit {
namespace {

constexpr double kTop = 255;
constexpr double kFilterSteps = 256;

struct Word {
  std::string_view name;
  bool StorageModel::*flag;
};
constexpr std::array<Word, 4> kWords = {Word{"half", &StorageModel::half},
                                        {"r11g11b10", &StorageModel::r11g11b10},
                                        {"filter8", &StorageModel::filter8},
                                        {"output8", &StorageModel::output8}};

optics::SmallFloat BufferOf(Channel channel) {
  return channel == Channel::kBlue ? optics::kFloat10 : optics::kFloat11;
}

}  // namespace

std::string NameOf(const StorageModel& storage) {
  std::string names;
  for (const Word& word : kWords) {
    if (storage.*word.flag)
      absl::StrAppend(&names, names.empty() ? "" : ",", std::string(word.name));
  }
  return names.empty() ? "exact" : names;
}

absl::StatusOr<StorageModel> StorageModelOf(std::string_view names) {
  StorageModel storage;
  if (names == "exact") return storage;
  while (true) {
    const std::string_view name = names.substr(0, names.find(','));
    bool known = false;
    for (const Word& word : kWords) {
      if (name != word.name) continue;
      storage.*word.flag = true;
      known = true;
    }
    if (!known) {
      return BadInput("storage model", absl::StrCat("\"", std::string(name), "\" is none"),
                      "give half, r11g11b10, filter8 and output8, parted by commas, or exact");
    }
    if (name.size() == names.size()) return storage;
    names.remove_prefix(name.size() + 1);
  }
}

std::vector<StorageModel> ModelsOf(const StorageModel& storage) {
  std::vector<StorageModel> models;
  for (const Word& word : kWords) {
    if (!(storage.*word.flag)) continue;
    models.emplace_back().*word.flag = true;
  }
  if (models.size() > 1) models.push_back(storage);
  return models;
}

std::string_view NameOf(Channel channel) {
  constexpr std::array<std::string_view, 4> kNames = {"grey", "red", "green", "blue"};
  return kNames[static_cast<size_t>(channel)];
}

double StoragePath::HeldEntry(double entry) const {
  if (!storage_.half) return entry;
  return optics::StoredAs(optics::kFloat16, optics::Rounding::kNearestEven, entry);
}

double StoragePath::Buffered(double linear) const {
  if (!storage_.r11g11b10) return linear;
  return optics::StoredAs(BufferOf(channel_), optics::Rounding::kTruncate, linear);
}

double StoragePath::Weight(double weight) const {
  return storage_.filter8 ? std::round(kFilterSteps * weight) / kFilterSteps : weight;
}

double StoragePath::Shown(double drive) const {
  return storage_.output8 ? std::round(kTop * drive) / kTop : drive;
}

double StoragePath::NextBuffered(double linear) const {
  const optics::SmallFloat format = BufferOf(channel_);
  const uint32_t bits = optics::EncodeSmallFloat(format, optics::Rounding::kTruncate, linear);
  return optics::DecodeSmallFloat(format, bits + 1);
}

double StoragePath::LeastBufferedFrom(double linear) const {
  if (!storage_.r11g11b10 || linear <= 0) return linear;
  const double below = Buffered(linear);
  return below == linear ? linear : NextBuffered(linear);
}

double StoragePath::MostBufferedTo(double linear) const {
  if (!storage_.r11g11b10 || std::isinf(linear)) return linear;
  return std::nextafter(NextBuffered(linear), 0.0);
}

double StoragePath::LeastShownFrom(double drive) const {
  return storage_.output8 ? (std::ceil(kTop * drive) - 0.5) / kTop : drive;
}

double StoragePath::MostShownTo(double drive) const {
  if (!storage_.output8) return drive;
  return std::nextafter((std::floor(kTop * drive) + 0.5) / kTop, 0.0);
}

}  // namespace eyebox::fit
