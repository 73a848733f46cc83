// Samples recorded before, given again as if the photodiode were there.
#ifndef EYEBOX_CAPTURE_PHOTODIODE_REPLAY_REPLAY_PHOTODIODE_H_
#define EYEBOX_CAPTURE_PHOTODIODE_REPLAY_REPLAY_PHOTODIODE_H_

#include <memory>

#include "absl/status/statusor.h"
#include "capture/photodiode/photodiode.h"

namespace eyebox::capture {

// config.uri is "replay:DIR" of a recording that holds samples, whose captures follow one another
// (suspect ones are left out, and times may jump between two); or DIR with DIR/photodiode.csv,
// which is preferred, or "replay:FILE"; columns monotonic_ns, counts and, where known, sequence,
// whose gaps are lost conversions. It is configured with any settings, since the samples are what
// they are; Read() gives OutOfRange after the last block. Start() begins again with the first one.
// Memory: the whole file. Errors: those of ReadCsv() and of RecordingReader; NotFound (a recording
// without samples); InvalidArgument (column missing, times or sequence not ascending; names the
// line).
absl::StatusOr<std::unique_ptr<Photodiode>> OpenReplayPhotodiode(const PhotodiodeConfig& config,
                                                                 const Clock* clock);

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_PHOTODIODE_REPLAY_REPLAY_PHOTODIODE_H_
