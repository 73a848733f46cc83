#include "capture/photodiode/sim/sim_photodiode.h"

#include <algorithm>
#include <cmath>
#include <thread>
#include <utility>

#include "capture/base/status.h"
#include "capture/camera/sim/noise.h"
#include "capture/photodiode/photodiode_state.h"

namespace eyebox::capture {
namespace {

constexpr std::string_view kScheme = "sim:";
constexpr uint64_t kSampleStream = 200;  // key apart from those of the simulated camera

struct Range {
  const char* field;
  double value;
  double minimum;
  double maximum;
};

// What the low-pass leaves of a strobe that has flashed forever: on each plateau the value relaxes
// exponentially, and the two ends must meet.
double Settled(const StrobeLight& light, double settling_s, double time_s) {
  if (settling_s <= 0 || light.duty >= 1) return light.At(time_s);
  const double periods = (time_s - light.phase_s) / light.period_s;
  const double since_s = (periods - std::floor(periods)) * light.period_s;
  const double lit_s = light.duty * light.period_s;
  const double decay_lit = std::exp(-lit_s / settling_s);
  const double decay_all = std::exp(-light.period_s / settling_s);
  const double top = (1 - decay_lit) / (1 - decay_all);
  const double bottom = top * decay_all / decay_lit;
  if (since_s < lit_s) return 1 - (1 - bottom) * std::exp(-since_s / settling_s);
  return top * std::exp(-(since_s - lit_s) / settling_s);
}

class SimPhotodiode final : public Photodiode {
 public:
  SimPhotodiode(PhotodiodeInfo info, const SimPhotodiodeParameters& parameters, uint64_t seed,
                const Clock* clock)
      : info_(std::move(info)),
        state_(info_.uri),
        parameters_(parameters),
        seed_(seed),
        clock_(clock) {}

  const PhotodiodeInfo& Info() const override { return info_; }

  absl::StatusOr<PhotodiodeSettings> Configure(const PhotodiodeSettings& settings) override {
    EYEBOX_RETURN_IF_ERROR(state_.CheckConfigure(info_, settings));
    state_.Configured(settings);
    return settings;
  }

  absl::Status Start() override {
    start_ns_ = clock_->MonotonicNs();
    next_ = 0;
    last_read_end_ = 0;
    return state_.Start(start_ns_);
  }

  absl::StatusOr<SampleBlock> Read(std::chrono::milliseconds timeout) override {
    EYEBOX_RETURN_IF_ERROR(state_.CheckRead());
    const auto deadline = std::chrono::steady_clock::now() + timeout;
    while (true) {
      SampleBlock block = NextBlock();
      if (!block.samples.empty()) return block;
      if (std::chrono::steady_clock::now() >= deadline) {
        return absl::DeadlineExceededError(
            Complaint(info_.uri, "no conversion is due yet", "wait longer"));
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }

  absl::Status Stop() override {
    state_.Stop();
    return absl::OkStatus();
  }

 private:
  double PeriodNs() const { return 1e9 / state_.settings().sample_rate_hz; }

  SampleBlock NextBlock() {
    const auto due_ns = static_cast<double>(clock_->MonotonicNs() - start_ns_);
    SampleBlock block;
    while (static_cast<int>(block.samples.size()) < parameters_.samples_per_block &&
           static_cast<double>(next_) * PeriodNs() <= due_ns) {
      NoiseSource noise({seed_, kSampleStream, next_});
      const bool lost = noise.Uniform() < parameters_.lost_share;
      if (lost && !block.samples.empty()) break;
      if (!lost) {
        if (block.samples.empty()) block.sequence = next_;
        block.samples.push_back(Convert(static_cast<double>(next_) * PeriodNs(), noise));
      }
      ++next_;
    }
    if (block.samples.empty()) return block;
    block.lost_before = block.sequence - last_read_end_;
    block.time_uncertainty_ns = std::llround(3e9 * parameters_.time_jitter_s);
    last_read_end_ = block.sequence + block.samples.size();
    return block;
  }

  PhotodiodeSample Convert(double since_start_ns, NoiseSource& noise) const {
    const double time_s = since_start_ns * 1e-9;
    const double light = Settled(parameters_.light, parameters_.settling_s, time_s);
    const double counts =
        parameters_.dark_counts +
        parameters_.level_counts * (1 + parameters_.drift_per_s * time_s) * light +
        parameters_.noise_counts * noise.Gaussian();
    // Jitter beyond a third of a period would let the reported times run backwards.
    const double limit_ns = PeriodNs() / 3;
    const double jitter_ns =
        std::clamp(parameters_.time_jitter_s * 1e9 * noise.Gaussian(), -limit_ns, limit_ns);
    return {.monotonic_ns = start_ns_ + std::llround(since_start_ns + jitter_ns),
            .counts = static_cast<int32_t>(
                std::lround(std::clamp(counts, 0.0, static_cast<double>(info_.maximum_counts))))};
  }

  const PhotodiodeInfo info_;
  PhotodiodeState state_;
  const SimPhotodiodeParameters parameters_;
  const uint64_t seed_;
  const Clock* const clock_;
  int64_t start_ns_ = 0;
  uint64_t next_ = 0;           // conversion
  uint64_t last_read_end_ = 0;  // conversion after the last that was read
};

struct Named {
  std::string_view name;
  StrobeLight light;
};

constexpr Named kNamed[] = {
    {"strobe-90hz", {.period_s = 1.0 / 90, .duty = 0.2}},
    {"strobe-72hz", {.period_s = 1.0 / 72, .duty = 0.1}},
    {"steady", {.period_s = 1.0 / 90, .duty = 1}},
};

}  // namespace

absl::Status SimPhotodiodeParameters::Validate() const {
  const Range ranges[] = {
      {"light.period_s", light.period_s, 1e-5, 10},
      {"light.duty", light.duty, 1e-6, 1},
      {"light.phase_s", light.phase_s, -1e3, 1e3},
      {"level_counts", level_counts, 0, 1e9},
      {"dark_counts", dark_counts, -1e9, 1e9},
      {"noise_counts", noise_counts, 0, 1e9},
      {"drift_per_s", drift_per_s, -1, 1},
      {"time_jitter_s", time_jitter_s, 0, 1},
      {"settling_s", settling_s, 0, 10},
      {"lost_share", lost_share, 0, 0.9},
      {"bits", static_cast<double>(bits), 1, 24},
      {"sample_rate_max_hz", sample_rate_max_hz, 1, 1e7},
      {"samples_per_block", static_cast<double>(samples_per_block), 1, 1e6},
  };
  for (const Range& range : ranges) {
    if (range.value >= range.minimum && range.value <= range.maximum) continue;
    return BadInput(std::string("SimPhotodiodeParameters.") + range.field,
                    "is " + std::to_string(range.value),
                    "give a value from " + std::to_string(range.minimum) + " to " +
                        std::to_string(range.maximum));
  }
  return absl::OkStatus();
}

std::vector<std::string> SimPhotodiodeNames() {
  std::vector<std::string> names;
  for (const Named& named : kNamed) names.emplace_back(named.name);
  return names;
}

absl::StatusOr<SimPhotodiodeParameters> NamedSimPhotodiode(std::string_view name) {
  std::string known;
  for (const Named& named : kNamed) {
    if (named.name == name) return SimPhotodiodeParameters{.light = named.light};
    known.append(" ").append(named.name);
  }
  return BadInput("simulated photodiode '" + std::string(name) + "'", "is not known",
                  "take one of" + known);
}

absl::StatusOr<std::unique_ptr<Photodiode>> MakeSimPhotodiode(
    const PhotodiodeConfig& config, const SimPhotodiodeParameters& parameters, const Clock* clock) {
  EYEBOX_RETURN_IF_ERROR(parameters.Validate());
  PhotodiodeInfo info = {.uri = config.uri,
                         .model = "Eyebox simulator",
                         .significant_bits = parameters.bits,
                         .minimum_counts = 0,
                         .maximum_counts = (int32_t{1} << parameters.bits) - 1,
                         .sample_rate_min_hz = 1e-3,
                         .sample_rate_max_hz = parameters.sample_rate_max_hz};
  return std::make_unique<SimPhotodiode>(std::move(info), parameters, config.seed, clock);
}

absl::StatusOr<std::unique_ptr<Photodiode>> OpenSimPhotodiode(const PhotodiodeConfig& config,
                                                              const Clock* clock) {
  EYEBOX_ASSIGN_OR_RETURN(const SimPhotodiodeParameters parameters,
                          NamedSimPhotodiode(std::string_view(config.uri).substr(kScheme.size())));
  return MakeSimPhotodiode(config, parameters, clock);
}

}  // namespace eyebox::capture
