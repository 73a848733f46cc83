#include "capture/recording/row_types.h"

#include <hdf5.h>

#include <cstddef>
#include <initializer_list>

#include "capture/recording/frame_record.h"
#include "capture/recording/side_rows.h"

namespace eyebox::capture {
namespace {

struct RowField {
  const char* name;
  size_t offset;
  hid_t type;
};

#define EYEBOX_FIELD(Row, name, type) \
  RowField { #name, offsetof(Row, name), type }

Hdf5Handle TypeOf(size_t bytes, std::initializer_list<RowField> fields) {
  Hdf5Handle type(H5Tcreate(H5T_COMPOUND, bytes), H5Tclose);
  for (const RowField& field : fields) H5Tinsert(type.id(), field.name, field.offset, field.type);
  return type;
}

}  // namespace

Hdf5Handle FrameRecordType() {
  return TypeOf(sizeof(FrameRecord),
                {
                    EYEBOX_FIELD(FrameRecord, camera_frame_id, H5T_STD_U64LE),
                    EYEBOX_FIELD(FrameRecord, device_time_ns, H5T_STD_I64LE),
                    EYEBOX_FIELD(FrameRecord, monotonic_time_ns, H5T_STD_I64LE),
                    EYEBOX_FIELD(FrameRecord, trigger_time_ns, H5T_STD_I64LE),
                    EYEBOX_FIELD(FrameRecord, exposure_asked_s, H5T_IEEE_F64LE),
                    EYEBOX_FIELD(FrameRecord, exposure_reported_s, H5T_IEEE_F64LE),
                    EYEBOX_FIELD(FrameRecord, gain_asked_db, H5T_IEEE_F64LE),
                    EYEBOX_FIELD(FrameRecord, gain_reported_db, H5T_IEEE_F64LE),
                    EYEBOX_FIELD(FrameRecord, black_level_dn, H5T_IEEE_F64LE),
                    EYEBOX_FIELD(FrameRecord, temperature_degC, H5T_IEEE_F64LE),
                    EYEBOX_FIELD(FrameRecord, photodiode_counts, H5T_IEEE_F64LE),
                    EYEBOX_FIELD(FrameRecord, frame_xxh3, H5T_STD_U64LE),
                    EYEBOX_FIELD(FrameRecord, frame_index, H5T_STD_U32LE),
                    EYEBOX_FIELD(FrameRecord, missing_packets, H5T_STD_U32LE),
                    EYEBOX_FIELD(FrameRecord, level_id, H5T_STD_I32LE),
                    EYEBOX_FIELD(FrameRecord, valid, H5T_STD_U16LE),
                    EYEBOX_FIELD(FrameRecord, state, H5T_STD_U8LE),
                    EYEBOX_FIELD(FrameRecord, buffer_status, H5T_STD_U8LE),
                    EYEBOX_FIELD(FrameRecord, record_xxh3, H5T_STD_U64LE),
                });
}

Hdf5Handle SampleRowType() {
  return TypeOf(sizeof(SampleRow), {
                                       EYEBOX_FIELD(SampleRow, monotonic_ns, H5T_STD_I64LE),
                                       EYEBOX_FIELD(SampleRow, device_time_ns, H5T_STD_I64LE),
                                       EYEBOX_FIELD(SampleRow, time_uncertainty_ns, H5T_STD_I64LE),
                                       EYEBOX_FIELD(SampleRow, sequence, H5T_STD_U64LE),
                                       EYEBOX_FIELD(SampleRow, lost_before, H5T_STD_U64LE),
                                       EYEBOX_FIELD(SampleRow, counts, H5T_STD_I32LE),
                                       EYEBOX_FIELD(SampleRow, flags, H5T_STD_U32LE),
                                   });
}

Hdf5Handle SampleGroupType() {
  return TypeOf(sizeof(SampleGroup), {
                                         EYEBOX_FIELD(SampleGroup, first, H5T_STD_U64LE),
                                         EYEBOX_FIELD(SampleGroup, count, H5T_STD_U64LE),
                                         EYEBOX_FIELD(SampleGroup, samples_lost, H5T_STD_U64LE),
                                         EYEBOX_FIELD(SampleGroup, samples_xxh3, H5T_STD_U64LE),
                                         EYEBOX_FIELD(SampleGroup, group_index, H5T_STD_U32LE),
                                         EYEBOX_FIELD(SampleGroup, written, H5T_STD_U32LE),
                                         EYEBOX_FIELD(SampleGroup, record_xxh3, H5T_STD_U64LE),
                                     });
}

Hdf5Handle TripleRowType() {
  return TypeOf(sizeof(TripleRow), {
                                       EYEBOX_FIELD(TripleRow, monotonic_ns, H5T_STD_I64LE),
                                       EYEBOX_FIELD(TripleRow, real_ns, H5T_STD_I64LE),
                                       EYEBOX_FIELD(TripleRow, device_ns, H5T_STD_I64LE),
                                       EYEBOX_FIELD(TripleRow, window_ns, H5T_STD_I64LE),
                                       EYEBOX_FIELD(TripleRow, triple_index, H5T_STD_U32LE),
                                       EYEBOX_FIELD(TripleRow, has_device, H5T_STD_U16LE),
                                       EYEBOX_FIELD(TripleRow, written, H5T_STD_U16LE),
                                       EYEBOX_FIELD(TripleRow, record_xxh3, H5T_STD_U64LE),
                                   });
}

}  // namespace eyebox::capture
