#include <algorithm>
#include <atomic>
#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "capture/base/npy.h"
#include "capture/base/status.h"
#include "capture/recording/reader.h"
#include "service/server/handlers/failed_stream.h"
#include "service/server/handlers/handlers.h"
#include "service/server/handlers/reply.h"
#include "service/server/handlers/result_files.h"
#include "service/server/handlers/stall_guard.h"
#include "service/server/store/served.h"

namespace eyebox::service {
namespace {

constexpr char kCaptures[] = "/captures/";
// Each holds its whole array while it is read, however slowly.
constexpr int kMostStreams = 8;

struct Array {
  std::string dtype;
  ImageSize size;
  std::string bytes;
};

// The frame of recordings/R/captures/C.
absl::StatusOr<Array> Frame(const RootFolder& data, const std::string& name, int wanted) {
  const size_t split = name.rfind(kCaptures);
  int number = 0;
  if (split == std::string::npos ||
      !absl::SimpleAtoi(name.substr(split + sizeof(kCaptures) - 1), &number)) {
    return BadField("name", Quoted(name) + " is neither a capture nor a job",
                    "give recordings/R/captures/C or jobs/J");
  }
  EYEBOX_ASSIGN_OR_RETURN(const std::string path,
                          CheckName(kRecordingNameRule, "name", name.substr(0, split)));
  EYEBOX_ASSIGN_OR_RETURN(const OwnedFd folder, data.OpenFolder(path));
  EYEBOX_ASSIGN_OR_RETURN(const auto reader, capture::RecordingReader::Open(folder.Path()));
  const auto captures = reader->Captures();
  const auto entry = std::ranges::find(captures, number, &capture::CaptureEntry::number);
  if (entry == captures.end() || wanted < 0 || wanted >= entry->frame_count) {
    return WithField(Missing("name", absl::StrCat("there is no frame ", wanted, " of ", name),
                             "list the captures, and count frames from 0"),
                     "name");
  }
  if (entry->packed) {
    return WithField(Rejected("name", name + " is packed, and the server unpacks nothing",
                              "create a reduce job, or read the file with h5py"),
                     "name");
  }
  Array array{.dtype = "<u2", .size = entry->frame_size, .bytes = {}};
  int at = 0;
  const absl::Status read = reader->VisitFrames(*entry, [&](const eyebox::Frame& frame) {
    if (at++ < wanted) return absl::OkStatus();
    const auto pixels = frame.view.pixels_dn;
    array.bytes.assign(reinterpret_cast<const char*>(pixels.data()), pixels.size_bytes());
    return absl::CancelledError("this was the frame");
  });
  if (array.bytes.empty()) return read;
  return array;
}

absl::StatusOr<Array> MapOf(Jobs& jobs, const std::string& name, const std::string& artifact) {
  EYEBOX_ASSIGN_OR_RETURN(const ResultFile file, ResultFile::Open(jobs, name, artifact));
  auto map = ReadNpy(file.path());
  if (!map.ok()) {
    return absl::Status(
        map.status().code(),
        absl::StrReplaceAll(map.status().message(), {{file.path().string(), artifact}}));
  }
  Array array{.dtype = "<f4", .size = map->size(), .bytes = {}};
  array.bytes.assign(reinterpret_cast<const char*>(map->pixels().data()),
                     map->pixels().size_bytes());
  return array;
}

absl::StatusOr<Array> Load(const HandlerContext& context, const v1::ReadArrayRequest& request) {
  auto array = request.name().starts_with(kJobRule.prefix)
                   ? MapOf(context.jobs, request.name(), request.artifact())
                   : Frame(context.recordings, request.name(), request.frame());
  if (!array.ok() || request.offset() <= array->bytes.size()) return array;
  return WithField(absl::OutOfRangeError(
                       Complaint("offset",
                                 absl::StrCat(request.offset(), " is beyond the end of the array, ",
                                              array->bytes.size(), " bytes"),
                                 "give an offset within it")),
                   "offset");
}

v1::ArrayChunk ChunkOf(const Array& array, uint64_t offset) {
  v1::ArrayChunk chunk;
  chunk.set_dtype(array.dtype);
  chunk.add_shape(array.size.height_px);
  chunk.add_shape(array.size.width_px);
  chunk.set_offset(offset);
  chunk.set_total_bytes(array.bytes.size());
  chunk.set_data(array.bytes.substr(offset, kStreamChunkBytes));
  return chunk;
}

absl::StatusOr<v1::ArrayChunk> ReadChunk(const HandlerContext& context,
                                         const v1::ReadArrayRequest& request) {
  EYEBOX_ASSIGN_OR_RETURN(const Array array, Load(context, request));
  return ChunkOf(array, request.offset());
}

// As DownloadCall: one chunk is written at a time, and no thread waits for a slow client.
class ArrayCall final : public grpc::ServerWriteReactor<v1::ArrayChunk> {
 public:
  ArrayCall(const HandlerContext& context, grpc::CallbackServerContext* call,
            const v1::ReadArrayRequest& request)
      : context_(context),
        request_(request),
        next_(request.offset()),
        guard_(call, context.stalled_after) {
    context_.disk.Post([this] { Begin(); });
  }

  static std::atomic<int>& Count() {
    static std::atomic<int> count = 0;
    return count;
  }

  void OnWriteDone(bool ok) override {
    guard_.WriteEnds();
    if (ok) return WriteNext();
    Finish(grpc::Status(grpc::StatusCode::CANCELLED, "the client went away"));
  }
  void OnDone() override {
    --Count();
    delete this;
  }

 private:
  void Begin() {
    auto array = Load(context_, request_);
    if (!array.ok()) return Finish(ToRpcStatus(array.status()));
    array_ = *std::move(array);
    WriteNext();
  }

  void WriteNext() {
    chunk_ = ChunkOf(array_, next_);
    next_ += chunk_.data().size();
    guard_.WriteBegins();
    if (next_ < array_.bytes.size()) {
      StartWrite(&chunk_);
    } else {
      StartWriteAndFinish(&chunk_, {}, grpc::Status::OK);
    }
  }

  const HandlerContext& context_;
  const v1::ReadArrayRequest request_;
  Array array_;
  v1::ArrayChunk chunk_;  // being written
  uint64_t next_;
  StallGuard guard_;
};

}  // namespace

grpc::ServerUnaryReactor* ReadArray(const HandlerContext& context,
                                    grpc::CallbackServerContext* call,
                                    const v1::ReadArrayRequest* request, v1::ArrayChunk* response) {
  grpc::ServerUnaryReactor* reactor = call->DefaultReactor();
  context.disk.Post([&context, reactor, request, response] {
    Reply(reactor, ReadChunk(context, *request), response);
  });
  return reactor;
}

grpc::ServerWriteReactor<v1::ArrayChunk>* StreamArray(const HandlerContext& context,
                                                      grpc::CallbackServerContext* call,
                                                      const v1::ReadArrayRequest* request) {
  if (++ArrayCall::Count() > kMostStreams) {
    --ArrayCall::Count();
    return new FailedStream<v1::ArrayChunk>(absl::ResourceExhaustedError(
        Complaint("StreamArray", "8 arrays are being read already", "ask again in a moment")));
  }
  return new ArrayCall(context, call, *request);
}

}  // namespace eyebox::service
