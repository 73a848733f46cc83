#include "service/server/observe/metrics.h"

#include <prometheus/collectable.h>
#include <prometheus/counter.h>
#include <prometheus/exposer.h>
#include <prometheus/gauge.h>
#include <prometheus/histogram.h>
#include <prometheus/registry.h>
#include <prometheus/text_serializer.h>

#include <exception>
#include <utility>
#include <vector>

#include "capture/base/status.h"
#include "service/server/listen.h"
#include "service/server/store/names.h"

namespace eyebox::service {
namespace {

// From a look into memory to a run that somebody waits for.
const prometheus::Histogram::BucketBoundaries kLatencies_s = {0.001, 0.003, 0.01, 0.03, 0.1,
                                                              0.3,   1,     3,    10,   300};

prometheus::MetricFamily Gauge(const char* name, const char* help, double value) {
  prometheus::MetricFamily family;
  family.name = name;
  family.help = help;
  family.type = prometheus::MetricType::Gauge;
  family.metric.emplace_back().gauge.value = value;
  return family;
}

class Momentary final : public prometheus::Collectable {
 public:
  explicit Momentary(std::function<MomentaryFigures()> read) : read_(std::move(read)) {}
  std::vector<prometheus::MetricFamily> Collect() const override {
    const MomentaryFigures now = read_();
    return {Gauge("eyebox_jobs_queued", "Jobs that wait", now.jobs_queued),
            Gauge("eyebox_jobs_running", "Jobs under way", now.jobs_running),
            Gauge("eyebox_disk_free_bytes", "Free where data and state lie, the smaller of both",
                  static_cast<double>(now.disk_free_bytes)),
            Gauge("eyebox_serving", "1 while health says SERVING", now.serving ? 1 : 0)};
  }

 private:
  const std::function<MomentaryFigures()> read_;
};

bool IsLoopback(const std::string& host) {
  return host == "localhost" || host == "[::1]" || host.starts_with("127.");
}

}  // namespace

struct Metrics::Parts {
  explicit Parts(std::function<MomentaryFigures()> read)
      : momentary(std::make_shared<Momentary>(std::move(read))) {}

  const std::shared_ptr<prometheus::Registry> registry = std::make_shared<prometheus::Registry>();
  const std::shared_ptr<Momentary> momentary;
  prometheus::Family<prometheus::Counter>& calls = prometheus::BuildCounter()
                                                       .Name("eyebox_calls_total")
                                                       .Help("Calls that ended")
                                                       .Register(*registry);
  prometheus::Family<prometheus::Histogram>& latency = prometheus::BuildHistogram()
                                                           .Name("eyebox_call_seconds")
                                                           .Help("How long calls took")
                                                           .Register(*registry);
  prometheus::Gauge& open = prometheus::BuildGauge()
                                .Name("eyebox_calls_open")
                                .Help("Calls under way, streams included")
                                .Register(*registry)
                                .Add({});
  std::unique_ptr<prometheus::Exposer> exposer;  // last: it reads the others
};

Metrics::Metrics(std::function<MomentaryFigures()> momentary)
    : parts_(std::make_unique<Parts>(std::move(momentary))) {}
Metrics::~Metrics() = default;

void Metrics::CountCall(std::string_view method, std::string_view code, double seconds) {
  const std::string name(method);
  parts_->calls.Add({{"method", name}, {"code", std::string(code)}}).Increment();
  parts_->latency.Add({{"method", name}}, kLatencies_s).Observe(seconds);
}

void Metrics::CallOpened() { parts_->open.Increment(); }
void Metrics::CallClosed() { parts_->open.Decrement(); }

absl::StatusOr<int> Metrics::Expose(std::string_view address) {
  const auto endpoint = EndpointOf(address);
  if (!endpoint.ok() || !endpoint->tcp || !IsLoopback(endpoint->host)) {
    return BadInput("--metrics", Quoted(address) + " is no port of the loopback interface",
                    "give 127.0.0.1:PORT; whoever may log in here may read it");
  }
  try {
    parts_->exposer = std::make_unique<prometheus::Exposer>(endpoint->ForGrpc(), 1);
  } catch (const std::exception& error) {
    return DeviceFailed("--metrics", "cannot listen on " + Quoted(address),
                        "give a port that is free");
  }
  parts_->exposer->RegisterCollectable(parts_->registry);
  parts_->exposer->RegisterCollectable(parts_->momentary);
  const std::vector<int> ports = parts_->exposer->GetListeningPorts();
  return ports.empty() ? endpoint->port : ports.front();
}

std::string Metrics::Text() const {
  std::vector<prometheus::MetricFamily> all = parts_->registry->Collect();
  for (prometheus::MetricFamily& one : parts_->momentary->Collect()) all.push_back(std::move(one));
  return prometheus::TextSerializer().Serialize(all);
}

}  // namespace eyebox::service
