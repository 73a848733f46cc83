#include "optics/sensor/emva1288/descriptor.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "absl/strings/str_split.h"
#include "absl/strings/string_view.h"
#include "capture/base/file.h"
#include "capture/base/status.h"

namespace eyebox::optics {
namespace {

using Words = std::vector<absl::string_view>;

class Parser {
 public:
  Parser(std::string name, std::filesystem::path folder)
      : name_(std::move(name)), folder_(std::move(folder)) {}

  absl::StatusOr<Emva1288Descriptor> Parse(absl::string_view text) {
    for (const absl::string_view raw : absl::StrSplit(text, '\n')) {
      ++line_;
      const absl::string_view line = absl::StripAsciiWhitespace(raw);
      if (line.empty() || line[0] == '#') continue;
      EYEBOX_RETURN_IF_ERROR(TakeLine(line));
    }
    EYEBOX_RETURN_IF_ERROR(EndSet());
    if (result_.bits == 0) {
      return BadInput(name_, "it has no line \"n bits width height\"", "add one before the sets");
    }
    if (result_.sets.empty()) {
      return BadInput(name_, "it names no images", "add b and d lines, each with its i lines");
    }
    return std::move(result_);
  }

 private:
  std::string Here() const { return absl::StrCat(name_, ":", line_); }

  absl::Status TakeLine(absl::string_view line) {
    const Words words =
        absl::StrSplit(line, absl::ByAnyChar(" \t"), absl::SkipEmpty());  // never empty
    if (words[0] == "i") return TakeImage(line);
    if (words[0] == "v") return TakeVersion(words);
    if (words[0] == "n") return TakeFormat(words);
    if (words[0] == "b") return TakeSet(words, false);
    if (words[0] == "d") return TakeSet(words, true);
    return BadInput(Here(), absl::StrCat("unknown command \"", words[0], "\""),
                    "lines begin with v, n, b, d, i or #");
  }

  absl::Status TakeVersion(const Words& words) {
    if (words.size() != 2) return Malformed("v version");
    if (!result_.version.empty()) return BadInput(Here(), "a second v line", "keep one");
    result_.version = std::string(words[1]);
    return absl::OkStatus();
  }

  absl::Status TakeFormat(const Words& words) {
    if (result_.bits != 0) return BadInput(Here(), "a second n line", "keep one");
    int width = 0;
    int height = 0;
    int bits = 0;
    if (words.size() != 4 || !absl::SimpleAtoi(words[1], &bits) ||
        !absl::SimpleAtoi(words[2], &width) || !absl::SimpleAtoi(words[3], &height)) {
      return Malformed("n bits width height");
    }
    constexpr int kLargestSide = 1 << 16;
    if (bits < 1 || bits > 16 || width < 1 || height < 1 || width > kLargestSide ||
        height > kLargestSide) {
      return BadInput(Here(), "bits or size are out of range",
                      "give 1 to 16 bits and 1 to 65536 pixels a side");
    }
    result_.bits = bits;
    result_.size = {width, height};
    return absl::OkStatus();
  }

  absl::Status TakeSet(const Words& words, bool dark) {
    EYEBOX_RETURN_IF_ERROR(EndSet());
    DescribedSet set;
    set.dark = dark;
    set.line = line_;
    if (words.size() != (dark ? 2U : 3U) || !ToNumber(words[1], set.exposure_ns) ||
        (!dark && !ToNumber(words[2], set.photons))) {
      return Malformed(dark ? "d exposure_ns" : "b exposure_ns photons");
    }
    if (!(set.exposure_ns > 0) || (!dark && !(set.photons > 0))) {
      return BadInput(Here(), "exposure or photons are not above 0",
                      "give both as positive numbers; sets without light are d lines");
    }
    set_ = std::move(set);
    has_set_ = true;
    return absl::OkStatus();
  }

  // The rest of the line is the path: it may hold spaces.
  absl::Status TakeImage(absl::string_view line) {
    if (!has_set_) {
      return BadInput(Here(), "an image before the first b or d line",
                      "put a b or d line above its images");
    }
    const std::string path =
        absl::StrReplaceAll(absl::StripAsciiWhitespace(line.substr(1)), {{"\\", "/"}});
    if (path.empty()) return Malformed("i path");
    const std::filesystem::path relative(path);
    const bool drive = path.size() > 1 && path[1] == ':';
    const bool climbs = std::find(relative.begin(), relative.end(), "..") != relative.end();
    if (relative.is_absolute() || drive || climbs) {
      return BadInput(Here(), absl::StrCat("\"", path, "\" leaves the descriptor's folder"),
                      "give a path beneath it, without .. or drive");
    }
    set_.images.push_back({folder_ / relative, line_});
    return absl::OkStatus();
  }

  absl::Status EndSet() {
    if (!has_set_) return absl::OkStatus();
    const std::string where = absl::StrCat(name_, ":", set_.line);
    if (set_.images.size() < 2) {
      return BadInput(where, absl::StrCat("the set has ", set_.images.size(), " image(s)"),
                      "give at least two i lines after it");
    }
    for (const DescribedSet& other : result_.sets) {
      if (other.dark == set_.dark && other.exposure_ns == set_.exposure_ns &&
          other.photons == set_.photons && other.images.size() == set_.images.size()) {
        return BadInput(where, absl::StrCat("the same condition as line ", other.line),
                        "put the images of one condition into one set");
      }
    }
    result_.sets.push_back(std::exchange(set_, {}));
    has_set_ = false;
    return absl::OkStatus();
  }

  absl::Status Malformed(absl::string_view form) const {
    return BadInput(Here(), "the line does not have its form",
                    absl::StrCat("write \"", form, "\" with finite numbers"));
  }

  static bool ToNumber(absl::string_view word, double& number) {
    return absl::SimpleAtod(absl::StrReplaceAll(word, {{",", "."}}), &number) &&
           std::isfinite(number);
  }

  std::string name_;
  std::filesystem::path folder_;
  int line_ = 0;
  Emva1288Descriptor result_;
  DescribedSet set_;
  bool has_set_ = false;
};

}  // namespace

absl::StatusOr<Emva1288Descriptor> ParseEmva1288Descriptor(std::string_view text,
                                                           std::string_view name,
                                                           const std::filesystem::path& folder) {
  return Parser(std::string(name), folder).Parse(absl::string_view(text.data(), text.size()));
}

absl::StatusOr<Emva1288Descriptor> ReadEmva1288Descriptor(const std::filesystem::path& file) {
  EYEBOX_ASSIGN_OR_RETURN(const std::string text, ReadWholeFile(file));
  return ParseEmva1288Descriptor(text, file.string(), file.parent_path());
}

}  // namespace eyebox::optics
