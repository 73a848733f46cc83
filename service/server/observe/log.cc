#include "service/server/observe/log.h"

#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/base_sink.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include "absl/strings/str_format.h"

namespace eyebox::service {
namespace {

constexpr char kPattern[] = "{\"time\":\"%Y-%m-%dT%H:%M:%S.%eZ\",\"level\":\"%l\",%v}";

std::shared_ptr<spdlog::logger> LoggerTo(spdlog::sink_ptr sink) {
  auto logger = std::make_shared<spdlog::logger>("eyebox", std::move(sink));
  logger->set_formatter(
      std::make_unique<spdlog::pattern_formatter>(kPattern, spdlog::pattern_time_type::utc));
  logger->flush_on(spdlog::level::info);
  return logger;
}

// Hands over formatted lines.
class LineSink final : public spdlog::sinks::base_sink<std::mutex> {
 public:
  explicit LineSink(std::function<void(const std::string&)> take) : take_(std::move(take)) {}

 private:
  void sink_it_(const spdlog::details::log_msg& message) override {
    spdlog::memory_buf_t line;
    formatter_->format(message, line);
    std::string text(line.data(), line.size());
    while (!text.empty() && text.back() == '\n') text.pop_back();
    take_(text);
  }
  void flush_() override {}

  const std::function<void(const std::string&)> take_;
};

}  // namespace

struct ServerLog::Parts {
  std::shared_ptr<spdlog::logger> logger;
};

ServerLog::ServerLog()
    : parts_(new Parts{LoggerTo(std::make_shared<spdlog::sinks::stderr_sink_mt>())}) {}
ServerLog::ServerLog(std::function<void(const std::string&)> sink)
    : parts_(new Parts{LoggerTo(std::make_shared<LineSink>(std::move(sink)))}) {}
ServerLog::~ServerLog() = default;

void ServerLog::Write(Level level, std::string_view event, std::initializer_list<Field> fields) {
  std::string body = "\"event\":" + JsonString(event);
  for (const auto& [name, value] : fields) body += "," + JsonString(name) + ":" + JsonString(value);
  parts_->logger->log(level == Level::kInfo ? spdlog::level::info : spdlog::level::warn, "{}",
                      body);
}

std::string JsonString(std::string_view text) {
  std::string json = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      json += {'\\', c};
    } else if (byte < ' ') {
      json += absl::StrFormat("\\u%04x", byte);
    } else {
      json += byte < 0x7f ? c : '?';
    }
  }
  return json + "\"";
}

}  // namespace eyebox::service
