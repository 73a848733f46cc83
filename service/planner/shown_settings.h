// Settings that read what a scene shows, one by one, instead of fitting an activation.
#ifndef EYEBOX_SERVICE_PLANNER_SHOWN_SETTINGS_H_
#define EYEBOX_SERVICE_PLANNER_SHOWN_SETTINGS_H_

#include <vector>

#include "service/planner/cheapest.h"
#include "service/planner/predict_error.h"
#include "service/planner/setting.h"

namespace eyebox::service {

// Frames and exposures of everything that the scene shows, and the maps that go with them; darks
// and flats are left to the caller. Empty where what it shows varies: an activation is needed then.
std::vector<Setting> ShownSettings(const Predictor& predictor, const LeverGrid& grid);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_PLANNER_SHOWN_SETTINGS_H_
