// What a client sends: names of every kind, and whole requests. The first byte chooses.
#include <algorithm>
#include <array>
#include <string>

#include <google/protobuf/stubs/logging.h>

#include "eyebox/v1/capture_service.pb.h"
#include "eyebox/v1/job_service.pb.h"
#include "eyebox/v1/service.pb.h"
#include "service/server/handlers/validate_job.h"
#include "service/server/handlers/validate_preview.h"
#include "service/server/handlers/validate_run.h"
#include "service/server/listen.h"
#include "service/server/store/names.h"
#include "tests/fuzz/fuzz_input.h"

namespace eyebox::service {
namespace {

constexpr std::array kRules = {&kRequestIdRule, &kJobRule, &kRecordingRule,
                               &kArtifactRule,  &kRigRule, &kCameraRule};

void CheckRefusal(const absl::Status& status) {
  FUZZ_CHECK(!FieldOf(status).empty());
  FUZZ_CHECK(status.message().size() < 1000);
  FUZZ_CHECK(std::ranges::none_of(status.message(), [](char c) { return c >= 0 && c < ' '; }));
}

// Whatever passes leads nowhere but down.
void CheckHarmless(std::string_view name) {
  FUZZ_CHECK(!name.empty() && name.front() != '/' && name.back() != '/');
  const std::string framed = "/" + std::string(name) + "/";
  FUZZ_CHECK(framed.find("/../") == std::string::npos);
  FUZZ_CHECK(framed.find("/./") == std::string::npos);
  FUZZ_CHECK(framed.find("//") == std::string::npos);
  FUZZ_CHECK(std::ranges::all_of(name, [](char c) { return c > ' ' && c < 127 && c != '\\'; }));
}

void TryName(const NameRule& rule, std::string_view name) {
  const auto checked = CheckName(rule, "the_field", name);
  if (!checked.ok()) return CheckRefusal(checked.status());
  FUZZ_CHECK(name == std::string(rule.prefix) + *checked);
  CheckHarmless(*checked);
}

template <typename Request>
bool Parse(std::string_view bytes, Request& request) {
  // It would complain of every text that is no UTF-8.
  [[maybe_unused]] static const auto* const silenced = new google::protobuf::LogSilencer();
  return request.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()));
}

void TryJob(std::string_view bytes) {
  v1::CreateJobRequest request;
  if (!Parse(bytes, request)) return;
  const absl::Status valid = ValidateJob(request);
  if (!valid.ok()) return CheckRefusal(valid);
  CheckHarmless(request.request_id());
  for (const std::string& path :
       {request.run().recording(), request.reduce().source().recording(),
        request.uniformity().source().recording(), request.characterize().recording(),
        request.fit().csv(), request.fit().series().recording(), request.scatter().csv(),
        request.scatter().series().recording(), request.verify().csv(),
        request.verify().series().recording(), request.predict().csv(), request.predict().cube(),
        request.capture().rig(), request.tradeoff().recording(), request.plan().scene(),
        request.plan().recording()}) {
    if (!path.empty()) CheckHarmless(path);
  }
  for (const v1::Rig& rig : {request.run().rig(), request.capture().simulated(),
                             request.tradeoff().simulated(), request.plan().simulated()}) {
    FUZZ_CHECK(rig.sensor().empty());
  }
}

void TryPreview(std::string_view bytes) {
  v1::PreviewRequest request;
  if (!Parse(bytes, request)) return;
  const absl::Status valid = ValidatePreview(request);
  if (!valid.ok()) return CheckRefusal(valid);
  FUZZ_CHECK(request.exposure_s() >= 0 && request.exposure_s() <= 10);
  FUZZ_CHECK(request.most_width_px() >= 0 && request.most_width_px() <= 1024);
  if (request.has_rig()) return CheckHarmless(request.rig());
  CheckHarmless(request.simulated().camera_uri());
  FUZZ_CHECK(request.simulated().sensor().empty());
}

void TryRequest(std::string_view bytes) {
  v1::CreateRunRequest request;
  if (!Parse(bytes, request)) return;
  const absl::Status valid = ValidateRun(request);
  if (!valid.ok()) return CheckRefusal(valid);
  CheckHarmless(request.request_id());
  if (request.has_recording()) CheckHarmless(request.recording());
  if (!request.has_rig()) return;
  CheckHarmless(request.rig().name());
  CheckHarmless(request.rig().camera_uri());
  FUZZ_CHECK(request.rig().sensor().empty());
}

}  // namespace
}  // namespace eyebox::service

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace eyebox::service;
  if (size == 0) return 0;
  const std::string_view rest = eyebox::fuzz::AsText(data + 1, size - 1);
  if (data[0] < kRules.size()) {
    TryName(*kRules[data[0]], rest);
  } else if (data[0] == kRules.size()) {
    const auto endpoint = EndpointOf(rest);
    if (endpoint.ok())
      FUZZ_CHECK(EndpointOf(endpoint->ForGrpc())->ForGrpc() == endpoint->ForGrpc());
  } else if (data[0] == kRules.size() + 2) {
    TryJob(rest);
  } else if (data[0] == kRules.size() + 3) {
    TryPreview(rest);
  } else {
    TryRequest(rest);
  }
  return 0;
}
