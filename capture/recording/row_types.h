// The HDF5 types of the rows that we write past libhdf5. Called under its lock.
#ifndef EYEBOX_CAPTURE_RECORDING_ROW_TYPES_H_
#define EYEBOX_CAPTURE_RECORDING_ROW_TYPES_H_

#include "capture/recording/hdf5_handle.h"

namespace eyebox::capture {

Hdf5Handle FrameRecordType();
Hdf5Handle SampleRowType();
Hdf5Handle SampleGroupType();
Hdf5Handle TripleRowType();

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_RECORDING_ROW_TYPES_H_
