// What a run has read so far, and what a new reading must then be like.
#ifndef EYEBOX_CAPTURE_RUN_READING_LOG_H_
#define EYEBOX_CAPTURE_RUN_READING_LOG_H_

#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "capture/base/capture_spec.h"
#include "capture/run/frame_mean.h"

namespace eyebox::capture {

struct Reading {
  int number = 0;  // of the capture, as in its file name
  CaptureSpec spec;
  FrameMean mean;
};

struct PlausibilityOptions {
  double sigmas = 5;
  double relative = 0.02;        // of the signal: drift and flicker up to here are no wonder
  double dimmed_relative = 0.1;  // a reference that lost this much since the last one

  // Errors: InvalidArgument (names the field).
  absl::Status Validate() const;
};

class ReadingLog {
 public:
  explicit ReadingLog(const PlausibilityOptions& options) : options_(options) {}

  void Add(Reading reading) { readings_.push_back(std::move(reading)); }

  // A patch cannot be brighter than another one was whose drive values are all higher. In words
  // why `mean` is; empty where it is not. Afterglow of a bright patch makes a dark one so.
  std::string TooBright(const CaptureSpec& spec, const FrameMean& mean) const;
  // The same the other way round: an earlier patch that must have been too bright.
  std::string EarlierTooBright(const CaptureSpec& spec, const FrameMean& mean) const;

  // In words how a reference shows that the headset slept or dimmed since the last one; empty
  // where it does not, or where `spec` is no reference.
  std::string Dimmed(const CaptureSpec& spec, const FrameMean& mean) const;

  // Number of the last reference; 0: none.
  int LastReference() const;

 private:
  double DarkOf(const CaptureSpec& spec) const;
  bool IsAbove(const CaptureSpec& spec, const FrameMean& dark_patch, const FrameMean& bright) const;

  const PlausibilityOptions options_;
  std::vector<Reading> readings_;
};

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_RUN_READING_LOG_H_
