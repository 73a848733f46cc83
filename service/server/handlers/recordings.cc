// The calls that say what lies below the served folder.
#include <algorithm>
#include <iterator>
#include <utility>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "capture/base/status.h"
#include "capture/recording/convert.h"
#include "capture/recording/reader.h"
#include "service/server/catalogue/describe.h"
#include "service/server/handlers/handlers.h"
#include "service/server/handlers/reply.h"
#include "service/server/store/paging.h"
#include "service/server/store/rigs.h"
#include "service/server/store/served.h"

namespace eyebox::service {
namespace {

struct Page {
  std::vector<std::string> names;
  std::string next_token;
};

// The token is the last name of the page before: what appears meanwhile shifts nothing.
absl::StatusOr<Page> PageOf(const std::vector<std::string>& names, int page_size,
                            const std::string& token) {
  EYEBOX_ASSIGN_OR_RETURN(const int size, PageSizeOf(page_size));
  const auto first = std::ranges::upper_bound(names, token);
  const auto count = std::min<ptrdiff_t>(size, names.end() - first);
  Page page;
  page.names = {first, first + count};
  if (first + count != names.end()) page.next_token = page.names.back();
  return page;
}

v1::RigEntry DescribeRig(const RootFolder& data, const std::string& name) {
  v1::RigEntry entry;
  entry.set_name(name);
  const auto config = ReadRig(data, name);
  if (config.ok()) {
    *entry.mutable_rig() = capture::ToProto(*config);
  } else {
    entry.set_problem(std::string(config.status().message()));
  }
  return entry;
}

absl::StatusOr<v1::ListRigsResponse> Rigs(const RootFolder& data,
                                          const v1::ListRigsRequest& request) {
  EYEBOX_ASSIGN_OR_RETURN(const Served served, ListServed(data));
  EYEBOX_ASSIGN_OR_RETURN(const Page page,
                          PageOf(served.rigs, request.page_size(), request.page_token()));
  v1::ListRigsResponse response;
  for (const std::string& name : page.names) *response.add_rigs() = DescribeRig(data, name);
  response.set_next_page_token(page.next_token);
  return response;
}

absl::StatusOr<v1::RigEntry> Rig(const RootFolder& data, const std::string& name) {
  EYEBOX_ASSIGN_OR_RETURN(const capture::RigConfig config, ReadRig(data, name));
  v1::RigEntry entry;
  entry.set_name(name);
  *entry.mutable_rig() = capture::ToProto(config);
  return entry;
}

absl::StatusOr<v1::RecordingEntry> Recording(const RootFolder& data, const std::string& name) {
  EYEBOX_ASSIGN_OR_RETURN(const OpenRecording recording, OpenNamed(data, "name", name));
  return Describe(name, recording);
}

absl::StatusOr<v1::ListCapturesResponse> Captures(const RootFolder& data,
                                                  const v1::ListCapturesRequest& request) {
  EYEBOX_ASSIGN_OR_RETURN(const int size, PageSizeOf(request.page_size()));
  int after = 0;
  if (!request.page_token().empty() &&
      (!absl::SimpleAtoi(request.page_token(), &after) || after < 1)) {
    return BadField("page_token", Quoted(request.page_token()) + " is no token",
                    "give the next_page_token of the page before, or none for the first page");
  }
  EYEBOX_ASSIGN_OR_RETURN(const OpenRecording recording,
                          OpenNamed(data, "parent", request.parent()));
  v1::ListCapturesResponse response;
  for (const capture::CaptureEntry& one : recording.reader->Captures()) {
    if (one.number <= after) continue;
    if (response.captures_size() == size) {
      response.set_next_page_token(absl::StrCat(one.number - 1));
      break;
    }
    v1::CaptureEntry& entry = *response.add_captures();
    entry.set_name(absl::StrCat(request.parent(), "/captures/", one.number));
    *entry.mutable_capture() = capture::ToProto(one.spec);
    entry.set_frames(one.frame_count);
    entry.set_width_px(one.frame_size.width_px);
    entry.set_height_px(one.frame_size.height_px);
    entry.set_suspect(one.suspect);
  }
  return response;
}

// Answers from a thread of `executor`.
template <typename Answer, typename Message>
grpc::ServerUnaryReactor* From(Executor& executor, grpc::CallbackServerContext* call, Answer answer,
                               Message* response) {
  grpc::ServerUnaryReactor* reactor = call->DefaultReactor();
  executor.Post([reactor, answer, response] { Reply(reactor, answer(), response); });
  return reactor;
}

}  // namespace

grpc::ServerUnaryReactor* ListRigs(const HandlerContext& context, grpc::CallbackServerContext* call,
                                   const v1::ListRigsRequest* request,
                                   v1::ListRigsResponse* response) {
  return From(
      context.disk, call, [&context, request] { return Rigs(context.recordings, *request); },
      response);
}
grpc::ServerUnaryReactor* GetRig(const HandlerContext& context, grpc::CallbackServerContext* call,
                                 const v1::GetRigRequest* request, v1::RigEntry* response) {
  return From(
      context.disk, call, [&context, request] { return Rig(context.recordings, request->name()); },
      response);
}
grpc::ServerUnaryReactor* ListRecordings(const HandlerContext& context,
                                         grpc::CallbackServerContext* call,
                                         const v1::ListRecordingsRequest* request,
                                         v1::ListRecordingsResponse* response) {
  // It may have to read many recordings first, which must not hold up other calls.
  return From(
      context.catalogue_thread, call,
      [&context, request] { return context.catalogue.List(*request); }, response);
}
grpc::ServerUnaryReactor* GetRecording(const HandlerContext& context,
                                       grpc::CallbackServerContext* call,
                                       const v1::GetRecordingRequest* request,
                                       v1::RecordingEntry* response) {
  return From(
      context.disk, call,
      [&context, request] { return Recording(context.recordings, request->name()); }, response);
}
grpc::ServerUnaryReactor* ListCaptures(const HandlerContext& context,
                                       grpc::CallbackServerContext* call,
                                       const v1::ListCapturesRequest* request,
                                       v1::ListCapturesResponse* response) {
  return From(
      context.disk, call, [&context, request] { return Captures(context.recordings, *request); },
      response);
}

}  // namespace eyebox::service
