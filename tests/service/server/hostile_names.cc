#include "tests/service/server/hostile_names.h"

#include <chrono>
#include <utility>

#include "google/rpc/error_details.pb.h"
#include "google/rpc/status.pb.h"

namespace eyebox::service {
namespace {

class Context : public grpc::ClientContext {
 public:
  Context() { set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(60)); }
};

v1::CreateRunRequest GoodRun() {
  v1::CreateRunRequest request;
  request.set_request_id("id");
  request.mutable_rig()->set_name("rig");
  request.mutable_rig()->set_camera_uri("sim:rift-s-like");
  return request;
}

// CreateRun with one field of a good request replaced.
NameField OfCreateRun(const std::string& field,
                      std::function<void(v1::CreateRunRequest&, const std::string&)> set) {
  return {"CreateRun", field,
          [set = std::move(set)](v1::RunService::Stub& stub, const std::string& name) {
            v1::CreateRunRequest request = GoodRun();
            set(request, name);
            Context context;
            v1::Job job;
            return stub.CreateRun(&context, request, &job);
          }};
}

// A unary call that names a job.
template <typename Request, typename Response>
NameField OfJob(const std::string& call,
                grpc::Status (v1::RunService::Stub::*method)(grpc::ClientContext*, const Request&,
                                                             Response*)) {
  return {call, "name", [method](v1::RunService::Stub& stub, const std::string& name) {
            Request request;
            request.set_name(name);
            Context context;
            Response response;
            return (stub.*method)(&context, request, &response);
          }};
}

template <typename Message>
grpc::Status Drained(std::unique_ptr<grpc::ClientReader<Message>> reader) {
  Message message;
  while (reader->Read(&message)) {
  }
  return reader->Finish();
}

grpc::Status Watch(v1::RunService::Stub& stub, const std::string& name) {
  v1::WatchJobRequest request;
  request.set_name(name);
  Context context;
  return Drained(stub.WatchJob(&context, request));
}

grpc::Status Download(v1::RunService::Stub& stub, const std::string& job,
                      const std::string& artifact) {
  v1::DownloadArtifactRequest request;
  request.set_name(job);
  request.set_artifact(artifact);
  Context context;
  return Drained(stub.DownloadArtifact(&context, request));
}

grpc::Status Read(v1::RunService::Stub& stub, const std::string& job, const std::string& artifact) {
  v1::ReadArtifactRequest request;
  request.set_name(job);
  request.set_artifact(artifact);
  Context context;
  v1::ArtifactChunk chunk;
  return stub.ReadArtifact(&context, request, &chunk);
}

grpc::Status ListFrom(v1::RunService::Stub& stub, const std::string& token) {
  v1::ListJobsRequest request;
  request.set_page_token(token);
  Context context;
  v1::ListJobsResponse response;
  return stub.ListJobs(&context, request, &response);
}

std::vector<NameField> MakeNameFields() {
  using Stub = v1::RunService::Stub;
  // That of a job that succeeded, so that an artifact's name is all that can be wrong.
  const std::string job = "jobs/000001";
  return {
      OfCreateRun("request_id", [](auto& run, auto& name) { run.set_request_id(name); }),
      OfCreateRun("recording", [](auto& run, auto& name) { run.set_recording(name); }),
      OfCreateRun("rig.name", [](auto& run, auto& name) { run.mutable_rig()->set_name(name); }),
      OfCreateRun("rig.camera_uri",
                  [](auto& run, auto& name) { run.mutable_rig()->set_camera_uri(name); }),
      OfCreateRun("rig.photodiode_uri",
                  [](auto& run, auto& name) { run.mutable_rig()->set_photodiode_uri(name); }),
      OfCreateRun("rig.trigger_uri",
                  [](auto& run, auto& name) { run.mutable_rig()->set_trigger_uri(name); }),
      OfCreateRun("rig.camera_trigger_line",
                  [](auto& run, auto& name) { run.mutable_rig()->set_camera_trigger_line(name); }),
      OfCreateRun("rig.sensor", [](auto& run, auto& name) { run.mutable_rig()->set_sensor(name); }),
      OfJob<v1::GetJobRequest, v1::Job>("GetJob", &Stub::GetJob),
      OfJob<v1::WaitJobRequest, v1::Job>("WaitJob", &Stub::WaitJob),
      OfJob<v1::CancelJobRequest, v1::Job>("CancelJob", &Stub::CancelJob),
      OfJob<v1::GetRunResultRequest, v1::RunResult>("GetRunResult", &Stub::GetRunResult),
      {"WatchJob", "name", Watch},
      {"DownloadArtifact", "name",
       [](Stub& stub, auto& name) { return Download(stub, name, "result.json"); }},
      {"DownloadArtifact", "artifact",
       [job](Stub& stub, auto& name) { return Download(stub, job, name); }},
      {"ReadArtifact", "name",
       [](Stub& stub, auto& name) { return Read(stub, name, "result.json"); }},
      {"ReadArtifact", "artifact", [job](Stub& stub, auto& name) { return Read(stub, job, name); }},
      {"ListJobs", "page_token", ListFrom},
  };
}

}  // namespace

const std::vector<std::string>& HostileNames() {
  static const std::vector<std::string> names = {
      ".",
      "..",
      "/",
      "//",
      "./rec",
      "../rec",
      "../../etc/passwd",
      "rec/../../../etc/passwd",
      "/etc/passwd",
      "//etc/passwd",
      "/proc/self/environ",
      "/dev/zero",
      "rec/",
      "rec//captures",
      "rec/./captures",
      "rec/..",
      "..\\..\\secret",
      "C:\\secret",
      "\\\\host\\share",
      "file:///etc/passwd",
      "http://localhost/secret",
      "jobs/../lock",
      "jobs/000001/../../lock",
      "jobs/000001\n",
      "%2e%2e%2fsecret",
      "..%00/secret",
      std::string("rec\0.h5", 7),
      "rec\nrec",
      "rec\r\nrec",
      "rec\trec",
      "rec\x1b[2J",
      " rec",
      "rec ",
      "~root/.ssh/id_rsa",
      "$(reboot)",
      "`reboot`",
      "rec;reboot",
      "'; DROP TABLE jobs; --",
      "r\xC3\xA9"
      "c",  // é
      "rec\xE2\x80\xAE"
      "5h.",                              // right-to-left override
      "\xEF\xBC\x8E\xEF\xBC\x8E/secret",  // full-width dots
      "{{7*7}}",
      "%s%s%s%n",
      std::string(65, 'a') + "\x01",
      std::string(100000, 'a') + "/..",
  };
  return names;
}

const std::vector<NameField>& NameFields() {
  static const std::vector<NameField> fields = MakeNameFields();
  return fields;
}

std::string ViolatedField(const grpc::Status& status) {
  google::rpc::Status details;
  if (!details.ParseFromString(status.error_details())) return "";
  for (const auto& detail : details.details()) {
    google::rpc::BadRequest bad;
    if (detail.UnpackTo(&bad)) return bad.field_violations(0).field();
  }
  return "";
}

}  // namespace eyebox::service
