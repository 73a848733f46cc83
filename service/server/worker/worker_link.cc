#include "service/server/worker/worker_link.h"

#include <errno.h>
#include <sys/socket.h>

#include <cmath>
#include <cstring>

#include "capture/base/status.h"
#include "service/server/store/names.h"

namespace eyebox::service {
namespace {

constexpr size_t kMaxMessageBytes = size_t{128} << 10;
constexpr size_t kMaxWordsBytes = size_t{8} << 10;
constexpr int kLastCode = 16;  // UNAUTHENTICATED
constexpr char kProgressTag = 'P';
constexpr char kMayIGoOnTag = 'M';
constexpr char kEndTag = 'E';

template <typename T>
void Put(std::string& message, T value) {
  message.append(reinterpret_cast<const char*>(&value), sizeof(value));
}

template <typename T>
T At(const std::string& message, size_t offset) {
  T value;
  std::memcpy(&value, message.data() + offset, sizeof(value));
  return value;
}

void PutText(std::string& message, const std::string& text) {
  Put(message, static_cast<uint32_t>(text.size()));
  message += text;
}

std::optional<std::string> TakeText(const std::string& message, size_t& at) {
  if (message.size() - at < sizeof(uint32_t)) return std::nullopt;
  const size_t length = At<uint32_t>(message, at);
  at += sizeof(uint32_t);
  if (message.size() - at < length) return std::nullopt;
  at += length;
  return message.substr(at - length, length);
}

// A tag, a number and words.
template <typename T>
bool IsNumberAndWords(const std::string& message) {
  return message.size() >= 1 + sizeof(T) && message.size() <= 1 + sizeof(T) + kMaxWordsBytes;
}

}  // namespace

std::string EncodeAssignment(const Assignment& assignment) {
  std::string message;
  PutText(message, assignment.request.SerializeAsString());
  PutText(message, assignment.recording.string());
  PutText(message, assignment.out.string());
  return message;
}

absl::StatusOr<Assignment> DecodeAssignment(const std::string& message) {
  size_t at = 0;
  const auto request = TakeText(message, at);
  const auto recording = request ? TakeText(message, at) : std::nullopt;
  const auto out = recording ? TakeText(message, at) : std::nullopt;
  Assignment assignment;
  if (!out || at != message.size() || !assignment.request.ParseFromString(*request)) {
    return absl::InternalError(
        Complaint("worker", "was sent no assignment", "leave it to eyebox serve to start workers"));
  }
  assignment.recording = *recording;
  assignment.out = *out;
  return assignment;
}

std::string EncodeProgress(const Progress& progress) {
  std::string message(1, kProgressTag);
  Put(message, progress.fraction);
  return message + progress.step.substr(0, kMaxWordsBytes);
}

std::string EncodeMayIGoOn() { return std::string(1, kMayIGoOnTag); }

std::string EncodeEnd(const absl::Status& status) {
  std::string message(1, kEndTag);
  Put(message, static_cast<int32_t>(status.code()));
  return message + std::string(status.message().substr(0, kMaxWordsBytes));
}

std::optional<WorkerSays> DecodeWorker(const std::string& message) {
  if (message.empty()) return std::nullopt;
  if (message[0] == kMayIGoOnTag && message.size() == 1) return MayIGoOn{};
  if (message[0] == kProgressTag && IsNumberAndWords<double>(message)) {
    const auto fraction = At<double>(message, 1);
    if (!(fraction >= 0 && fraction <= 1)) return std::nullopt;
    return Progress{fraction, message.substr(1 + sizeof(fraction))};
  }
  if (message[0] == kEndTag && IsNumberAndWords<int32_t>(message)) {
    const auto code = At<int32_t>(message, 1);
    if (code < 0 || code > kLastCode) return std::nullopt;
    return absl::Status(static_cast<absl::StatusCode>(code), message.substr(1 + sizeof(code)));
  }
  return std::nullopt;
}

absl::Status Send(int socket, const std::string& message) {
  ssize_t sent = 0;
  do {
    sent = send(socket, message.data(), message.size(), MSG_NOSIGNAL);
  } while (sent < 0 && errno == EINTR);
  if (sent == static_cast<ssize_t>(message.size())) return absl::OkStatus();
  return absl::UnavailableError(
      Complaint("worker", "the other end is gone", "create the run again"));
}

absl::StatusOr<std::string> Receive(int socket) {
  std::string message(kMaxMessageBytes, '\0');
  ssize_t received = 0;
  do {
    received = recv(socket, message.data(), message.size(), MSG_TRUNC);
  } while (received < 0 && errno == EINTR);
  if (received <= 0) {
    return absl::UnavailableError(
        Complaint("worker", "the other end is gone", "create the run again"));
  }
  if (static_cast<size_t>(received) > message.size()) {
    return absl::ResourceExhaustedError(
        Complaint("worker", "sent too long a message", "create the run again"));
  }
  message.resize(static_cast<size_t>(received));
  return message;
}

}  // namespace eyebox::service
