// What the server did, one JSON object a line, for people and for machines.
#ifndef EYEBOX_SERVICE_SERVER_OBSERVE_LOG_H_
#define EYEBOX_SERVICE_SERVER_OBSERVE_LOG_H_

#include <functional>
#include <initializer_list>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

namespace eyebox::service {

// Thread-safe. Nothing that a client sends goes into it but names of calls, request ids that
// passed the table of names, and the server's own messages: no metadata, no token, no key.
class ServerLog {
 public:
  enum class Level { kInfo, kWarning };
  using Field = std::pair<std::string_view, std::string>;

  // To standard error.
  ServerLog();
  // To `sink`, one line without its end at a time; for tests.
  explicit ServerLog(std::function<void(const std::string& line)> sink);
  ~ServerLog();

  // {"time":"2024-05-01T10:00:00.000Z","level":"info","event":"call", ...}; values as strings.
  void Write(Level level, std::string_view event, std::initializer_list<Field> fields);

 private:
  struct Parts;
  const std::unique_ptr<Parts> parts_;
};

// `text` within quotes, as JSON has it; what is no ASCII becomes ?.
std::string JsonString(std::string_view text);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_SERVER_OBSERVE_LOG_H_
