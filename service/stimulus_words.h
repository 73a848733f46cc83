// What an experimenter, or a script, is asked to put before the camera.
#ifndef EYEBOX_SERVICE_STIMULUS_WORDS_H_
#define EYEBOX_SERVICE_STIMULUS_WORDS_H_

#include <string>

#include "capture/base/capture_spec.h"

namespace eyebox::service {

// "show a steady full field of drive 0.5".
std::string WhatToShow(const CaptureSpec& spec);

// Whether nothing has to change before the camera between the two.
bool IsSameScene(const CaptureSpec& one, const CaptureSpec& other);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_STIMULUS_WORDS_H_
