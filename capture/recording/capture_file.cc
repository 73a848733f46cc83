#include "capture/recording/capture_file.h"

#include <hdf5.h>

#include <filesystem>
#include <optional>
#include <system_error>

#include "capture/base/status.h"
#include "capture/recording/hdf5_handle.h"
#include "capture/recording/row_types.h"

namespace eyebox::capture {
namespace {

constexpr hsize_t kPage = 4096;        // frames begin on a page of the disk
constexpr hsize_t kAlignFrom = 65536;  // smaller objects lie close together
constexpr unsigned kDeflateLevel = 4;  // 6 takes twice as long for 1 % on noisy counts

absl::Status Refused(const std::filesystem::path& file, const std::string& what) {
  return absl::InternalError(
      Complaint(file.string(), what + " (" + Hdf5Complaint() + ")",
                "check the folder and the disk; report it if both are well"));
}

#define EYEBOX_HDF5(call, what) \
  if ((call) < 0) return Refused(file_, what)

using Dimensions = std::vector<hsize_t>;

Dimensions FramesDimensions(const CaptureFileShape& shape) {
  return {static_cast<hsize_t>(shape.frame_count), static_cast<hsize_t>(shape.frame_size.height_px),
          static_cast<hsize_t>(shape.frame_size.width_px)};
}

// One new file; every function is called under the lock.
class FileBuilder {
 public:
  FileBuilder(const std::filesystem::path& file, const CaptureFileShape& shape)
      : file_(file), shape_(shape), hdf5_(Create(file)) {}

  absl::Status AddRecords() {
    EYEBOX_RETURN_IF_ERROR(Opened());
    return AddRows("/frame_records", FrameRecordType(), static_cast<hsize_t>(shape_.frame_count),
                   layout_.records_offset_bytes);
  }

  // What there is room for; nothing where a capture has none.
  absl::Status AddSideRows() {
    layout_.side = shape_.side;
    SideRows& side = layout_.side;
    if (side.sample_capacity > 0) {
      Hdf5Handle group(H5Gcreate2(Id(), "/photodiode", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                       H5Gclose);
      EYEBOX_HDF5(group.id(), "cannot create /photodiode");
      EYEBOX_RETURN_IF_ERROR(Closed(group, "/photodiode"));
      EYEBOX_RETURN_IF_ERROR(AddRows("/photodiode/samples", SampleRowType(), side.sample_capacity,
                                     side.samples_offset_bytes));
      EYEBOX_RETURN_IF_ERROR(AddRows("/photodiode/groups", SampleGroupType(), side.group_capacity,
                                     side.groups_offset_bytes));
    }
    if (side.triple_capacity == 0) return absl::OkStatus();
    return AddRows("/clock_triples", TripleRowType(), side.triple_capacity,
                   side.triples_offset_bytes);
  }

  absl::Status AddContiguousFrames() {
    EYEBOX_ASSIGN_OR_RETURN(Hdf5Handle frames, Dataset("/frames", H5T_STD_U16LE,
                                                       FramesDimensions(shape_), Contiguous()));
    EYEBOX_RETURN_IF_ERROR(Offset(frames, layout_.frames_offset_bytes));
    return Closed(frames, "/frames");
  }

  absl::Status AddPackedFrames() {
    EYEBOX_ASSIGN_OR_RETURN(Hdf5Handle frames,
                            Dataset("/frames", H5T_STD_U16LE, FramesDimensions(shape_), Chunked()));
    packed_frames_.emplace(std::move(frames));
    return absl::OkStatus();
  }

  absl::Status AppendPacked(std::span<const uint16_t> pixels_dn) {
    const Hdf5Handle there(H5Dget_space(packed_frames_->id()), H5Sclose);
    Dimensions count = FramesDimensions(shape_);
    count[0] = 1;
    const Hdf5Handle here(H5Screate_simple(3, count.data(), nullptr), H5Sclose);
    const Dimensions start = {appended_, 0, 0};
    EYEBOX_HDF5(H5Sselect_hyperslab(there.id(), H5S_SELECT_SET, start.data(), nullptr, count.data(),
                                    nullptr),
                "cannot select a frame");
    EYEBOX_HDF5(H5Dwrite(packed_frames_->id(), H5T_NATIVE_UINT16, here.id(), there.id(),
                         H5P_DEFAULT, pixels_dn.data()),
                "cannot write a frame");
    ++appended_;
    return absl::OkStatus();
  }

  absl::Status AddMeta(const MetaStrings& meta) {
    Hdf5Handle group(H5Gcreate2(Id(), "/meta", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
    EYEBOX_HDF5(group.id(), "cannot create /meta");
    for (const auto& [name, text] : meta) EYEBOX_RETURN_IF_ERROR(AddString(group, name, text));
    return Closed(group, "/meta");
  }

  absl::StatusOr<CaptureFileLayout> Finish() {
    if (packed_frames_ && !packed_frames_->Close()) return Refused(file_, "cannot be closed");
    if (!hdf5_.Close()) return Refused(file_, "cannot be closed");
    std::error_code error;
    layout_.file_bytes = std::filesystem::file_size(file_, error);
    if (error) return SystemFailed(file_.string(), error.value(), "check the disk");
    return layout_;
  }

 private:
  static Hdf5Handle Create(const std::filesystem::path& file) {
    const Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    H5Pset_alignment(access.id(), kAlignFrom, kPage);
    H5Pset_fclose_degree(access.id(), H5F_CLOSE_STRONG);
    return {H5Fcreate(file.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access.id()), H5Fclose};
  }

  hid_t Id() const { return hdf5_.id(); }

  absl::Status Opened() const {
    return hdf5_.ok() ? absl::OkStatus() : Refused(file_, "cannot be created");
  }

  static Hdf5Handle Contiguous() {
    Hdf5Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    H5Pset_layout(creation.id(), H5D_CONTIGUOUS);
    H5Pset_alloc_time(creation.id(), H5D_ALLOC_TIME_EARLY);
    H5Pset_fill_time(creation.id(), H5D_FILL_TIME_NEVER);
    H5Pset_obj_track_times(creation.id(), false);  // same content, same bytes
    return creation;
  }

  Hdf5Handle Chunked() const {
    Hdf5Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    Dimensions chunk = FramesDimensions(shape_);
    chunk[0] = 1;
    H5Pset_chunk(creation.id(), 3, chunk.data());
    H5Pset_shuffle(creation.id());
    H5Pset_deflate(creation.id(), kDeflateLevel);
    H5Pset_fill_time(creation.id(), H5D_FILL_TIME_NEVER);
    H5Pset_obj_track_times(creation.id(), false);
    return creation;
  }

  absl::Status AddRows(const char* name, const Hdf5Handle& type, hsize_t rows,
                       uint64_t& offset_bytes) {
    EYEBOX_ASSIGN_OR_RETURN(Hdf5Handle dataset, Dataset(name, type.id(), {rows}, Contiguous()));
    EYEBOX_RETURN_IF_ERROR(Offset(dataset, offset_bytes));
    return Closed(dataset, name);
  }

  absl::StatusOr<Hdf5Handle> Dataset(const char* name, hid_t type, const Dimensions& dimensions,
                                     const Hdf5Handle& creation) {
    const Hdf5Handle space(
        H5Screate_simple(static_cast<int>(dimensions.size()), dimensions.data(), nullptr),
        H5Sclose);
    Hdf5Handle dataset(
        H5Dcreate2(Id(), name, type, space.id(), H5P_DEFAULT, creation.id(), H5P_DEFAULT),
        H5Dclose);
    EYEBOX_HDF5(dataset.id(), std::string("cannot create ") + name);
    return dataset;
  }

  absl::Status Offset(const Hdf5Handle& dataset, uint64_t& offset_bytes) {
    const haddr_t offset = H5Dget_offset(dataset.id());
    if (offset == HADDR_UNDEF) return Refused(file_, "has a dataset without a place");
    offset_bytes = offset;
    return absl::OkStatus();
  }

  absl::Status AddString(const Hdf5Handle& group, const std::string& name,
                         const std::string& text) {
    const Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
    H5Tset_size(type.id(), text.size() + 1);  // ends with a zero byte
    H5Tset_cset(type.id(), H5T_CSET_UTF8);
    const Hdf5Handle space(H5Screate(H5S_SCALAR), H5Sclose);
    const Hdf5Handle creation = Contiguous();
    Hdf5Handle dataset(H5Dcreate2(group.id(), name.c_str(), type.id(), space.id(), H5P_DEFAULT,
                                  creation.id(), H5P_DEFAULT),
                       H5Dclose);
    EYEBOX_HDF5(dataset.id(), "cannot create /meta/" + name);
    EYEBOX_HDF5(H5Dwrite(dataset.id(), type.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, text.c_str()),
                "cannot write /meta/" + name);
    return Closed(dataset, "/meta/" + name);
  }

  // Closing writes what libhdf5 still holds of the dataset.
  absl::Status Closed(Hdf5Handle& dataset, const std::string& name) const {
    return dataset.Close() ? absl::OkStatus() : Refused(file_, "cannot write " + name);
  }

  const std::filesystem::path file_;
  const CaptureFileShape shape_;
  Hdf5Handle hdf5_;
  std::optional<Hdf5Handle> packed_frames_;
  hsize_t appended_ = 0;
  CaptureFileLayout layout_;
};

class LockedPackedFile final : public PackedFileWriter {
 public:
  LockedPackedFile(const std::filesystem::path& file, const CaptureFileShape& shape)
      : builder_(std::in_place, file, shape) {}

  ~LockedPackedFile() override {
    const Hdf5Lock lock;
    builder_.reset();
  }

  absl::Status Begin(const MetaStrings& meta) {
    EYEBOX_RETURN_IF_ERROR(builder_->AddRecords());
    EYEBOX_RETURN_IF_ERROR(builder_->AddMeta(meta));
    EYEBOX_RETURN_IF_ERROR(builder_->AddSideRows());
    return builder_->AddPackedFrames();
  }

  absl::Status Append(std::span<const uint16_t> pixels_dn) override {
    const Hdf5Lock lock;
    return builder_->AppendPacked(pixels_dn);
  }

  absl::StatusOr<CaptureFileLayout> Finish() override {
    const Hdf5Lock lock;
    return builder_->Finish();
  }

 private:
  std::optional<FileBuilder> builder_;
};

}  // namespace

absl::StatusOr<CaptureFileLayout> CreateCaptureFile(const std::filesystem::path& file,
                                                    const CaptureFileShape& shape,
                                                    const MetaStrings& meta) {
  const Hdf5Lock lock;
  FileBuilder builder(file, shape);
  EYEBOX_RETURN_IF_ERROR(builder.AddRecords());
  EYEBOX_RETURN_IF_ERROR(builder.AddMeta(meta));
  EYEBOX_RETURN_IF_ERROR(builder.AddSideRows());
  EYEBOX_RETURN_IF_ERROR(builder.AddContiguousFrames());
  return builder.Finish();
}

absl::StatusOr<std::unique_ptr<PackedFileWriter>> PackedFileWriter::Create(
    const std::filesystem::path& file, const CaptureFileShape& shape, const MetaStrings& meta) {
  std::unique_ptr<LockedPackedFile> writer;
  absl::Status begun;
  {
    const Hdf5Lock lock;
    writer = std::make_unique<LockedPackedFile>(file, shape);
    begun = writer->Begin(meta);
  }
  if (!begun.ok()) return begun;
  return writer;
}

}  // namespace eyebox::capture
