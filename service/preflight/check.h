// What a check of the preflight says: a figure with its uncertainty, what it must be, the verdict,
// and, unless it passed, the cause and the remedy.
#ifndef EYEBOX_SERVICE_PREFLIGHT_CHECK_H_
#define EYEBOX_SERVICE_PREFLIGHT_CHECK_H_

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace eyebox::service {

enum class Verdict {
  kPassed,
  kFailed,   // is not as wanted, or could not be proven
  kSkipped,  // there is nothing to measure it with
};

struct Figure {
  std::string name;
  double value = 0;
  double sigma = 0;  // standard uncertainty; 0 where it is a count or a setting
  std::string unit;
};

struct Check {
  std::string name;
  Verdict verdict = Verdict::kPassed;
  std::optional<Figure> measured = {};  // the figure that decides
  std::string wanted;
  double threshold = 0;  // that `measured` is held against, in its unit
  std::string cause = {};
  std::string remedy = {};
  std::vector<Figure> figures = {};  // further ones

  Check Failed(std::string why, std::string what_to_do) && {
    verdict = Verdict::kFailed;
    cause = std::move(why);
    remedy = std::move(what_to_do);
    return std::move(*this);
  }
  Check Skipped(std::string why, std::string what_to_do) && {
    verdict = Verdict::kSkipped;
    cause = std::move(why);
    remedy = std::move(what_to_do);
    return std::move(*this);
  }
};

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_PREFLIGHT_CHECK_H_
