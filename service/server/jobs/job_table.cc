#include "service/server/jobs/job_table.h"

#include <algorithm>
#include <utility>

#include "capture/base/status.h"

namespace eyebox::service {

bool HasEnded(const v1::Job& job) {
  return job.state() == v1::JOB_STATE_SUCCEEDED || job.state() == v1::JOB_STATE_FAILED ||
         job.state() == v1::JOB_STATE_CANCELLED;
}

void JobTable::Insert(int64_t number, const v1::CreateJobRequest& request,
                      std::vector<v1::JobEvent> events) {
  const std::lock_guard lock(mutex_);
  if (!request.request_id().empty()) by_request_id_[request.request_id()] = number;
  entries_[number] = {request, std::move(events), {}};
}

void JobTable::Append(int64_t number, const v1::JobEvent& event) {
  {
    const std::lock_guard lock(mutex_);
    const auto entry = entries_.find(number);
    if (entry == entries_.end()) return;
    entry->second.events.push_back(event);
  }
  Notify(number);
}

absl::StatusOr<const JobTable::Entry*> JobTable::Find(int64_t number) const {
  const auto entry = entries_.find(number);
  if (entry == entries_.end()) {
    return Missing("name", "there is no such job", "list the jobs to see their names");
  }
  return &entry->second;
}

absl::StatusOr<v1::Job> JobTable::Latest(int64_t number) const {
  const std::lock_guard lock(mutex_);
  EYEBOX_ASSIGN_OR_RETURN(const Entry* entry, Find(number));
  return entry->events.back().job();
}

absl::StatusOr<v1::CreateJobRequest> JobTable::Request(int64_t number) const {
  const std::lock_guard lock(mutex_);
  EYEBOX_ASSIGN_OR_RETURN(const Entry* entry, Find(number));
  return entry->request;
}

absl::StatusOr<std::optional<v1::JobEvent>> JobTable::Event(int64_t number,
                                                            uint32_t sequence) const {
  const std::lock_guard lock(mutex_);
  EYEBOX_ASSIGN_OR_RETURN(const Entry* entry, Find(number));
  if (sequence == 0 || sequence > entry->events.size()) return std::nullopt;
  return entry->events[sequence - 1];
}

std::optional<int64_t> JobTable::WithRequestId(const std::string& request_id) const {
  const std::lock_guard lock(mutex_);
  const auto found = by_request_id_.find(request_id);
  if (found == by_request_id_.end()) return std::nullopt;
  return found->second;
}

std::vector<v1::Job> JobTable::Page(int64_t before, int count) const {
  const std::lock_guard lock(mutex_);
  std::vector<v1::Job> page;
  for (auto entry = entries_.lower_bound(before);
       entry != entries_.begin() && static_cast<int>(page.size()) < count;) {
    page.push_back((--entry)->second.events.back().job());
  }
  return page;
}

int JobTable::CountOf(v1::JobState state) const {
  const std::lock_guard lock(mutex_);
  return static_cast<int>(std::count_if(entries_.begin(), entries_.end(), [&](const auto& entry) {
    return entry.second.events.back().job().state() == state;
  }));
}

int64_t JobTable::NextNumber() const {
  const std::lock_guard lock(mutex_);
  return entries_.empty() ? 1 : entries_.rbegin()->first + 1;
}

absl::StatusOr<uint64_t> JobTable::AddListener(int64_t number, Listener listener) {
  const std::lock_guard lock(mutex_);
  EYEBOX_RETURN_IF_ERROR(Find(number).status());
  entries_[number].listeners[next_listener_] =
      std::make_shared<const Listener>(std::move(listener));
  return next_listener_++;
}

void JobTable::RemoveListener(int64_t number, uint64_t id) {
  std::shared_ptr<const Listener> removed;  // destroyed after the lock is given back
  const std::lock_guard lock(mutex_);
  const auto entry = entries_.find(number);
  if (entry == entries_.end()) return;
  const auto listener = entry->second.listeners.find(id);
  if (listener == entry->second.listeners.end()) return;
  removed = std::move(listener->second);
  entry->second.listeners.erase(listener);
}

void JobTable::Notify(int64_t number) const {
  std::vector<std::shared_ptr<const Listener>> listeners;
  {
    const std::lock_guard lock(mutex_);
    const auto entry = entries_.find(number);
    if (entry == entries_.end()) return;
    for (const auto& [id, listener] : entry->second.listeners) listeners.push_back(listener);
  }
  for (const auto& listener : listeners) (*listener)();
}

void JobTable::NotifyAll() const {
  std::vector<std::shared_ptr<const Listener>> listeners;
  {
    const std::lock_guard lock(mutex_);
    for (const auto& [number, entry] : entries_) {
      for (const auto& [id, listener] : entry.listeners) listeners.push_back(listener);
    }
  }
  for (const auto& listener : listeners) (*listener)();
}

}  // namespace eyebox::service
