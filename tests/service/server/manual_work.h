// Work whose steps the test decides, and a folder of its own for every test.
#ifndef EYEBOX_TESTS_SERVICE_SERVER_MANUAL_WORK_H_
#define EYEBOX_TESTS_SERVICE_SERVER_MANUAL_WORK_H_

#include <condition_variable>
#include <cstdlib>
#include <filesystem>
#include <mutex>
#include <string>
#include <utility>

#include "absl/status/status.h"
#include "capture/base/file.h"
#include "capture/base/status.h"
#include "service/server/jobs/jobs.h"

namespace eyebox::service {

class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string form = (std::filesystem::temp_directory_path() / "eyebox-XXXXXX").string();
    path_ = mkdtemp(form.data());
  }
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

// Each run goes step by step, one for each Allow(); it is asked to stop between steps as real work
// is. A run takes kSteps steps and then writes its files; after SayMuch() more, and wordier ones.
class ManualWork {
 public:
  static constexpr int kSteps = 4;

  ~ManualWork() { Allow(1 << 20); }

  Work AsWork() {
    return [this](const Assignment& assignment, const Watcher& watcher) {
      return Run(assignment, watcher);
    };
  }

  void Allow(int steps) {
    const std::lock_guard lock(mutex_);
    allowed_ += steps;
    changed_.notify_all();
  }
  void AllowAll() { Allow(1 << 20); }
  // Returns once `count` runs in all have begun.
  void AwaitBegun(int count) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return begun_ >= count; });
  }
  void FailWith(absl::Status status) {
    const std::lock_guard lock(mutex_);
    failure_ = std::move(status);
  }
  void SetFile(std::string name, std::string bytes) {
    const std::lock_guard lock(mutex_);
    file_ = std::move(name);
    bytes_ = std::move(bytes);
  }
  void SayMuch(int steps, size_t letters_each) {
    const std::lock_guard lock(mutex_);
    steps_ = steps;
    words_ = std::string(letters_each, 'x');
  }
  int begun() const {
    const std::lock_guard lock(mutex_);
    return begun_;
  }

 private:
  absl::Status Run(const Assignment& assignment, const Watcher& watcher) {
    {
      const std::lock_guard lock(mutex_);
      ++begun_;
      changed_.notify_all();
    }
    for (int step = 1; step <= steps_; ++step) {
      AwaitAllowed();
      EYEBOX_RETURN_IF_ERROR(watcher.Reach(static_cast<double>(step) / steps_,
                                           "step " + std::to_string(step) + words_));
    }
    const std::lock_guard lock(mutex_);
    EYEBOX_RETURN_IF_ERROR(failure_);
    EYEBOX_RETURN_IF_ERROR(WriteFileAtomically(assignment.out / file_, bytes_));
    return WriteFileAtomically(assignment.out / "result.json", R"({"files": ["uniformity.json"]})");
  }

  void AwaitAllowed() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return allowed_ > 0; });
    --allowed_;
  }

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  int steps_ = kSteps;
  std::string words_;
  int allowed_ = 0;
  int begun_ = 0;
  absl::Status failure_;
  std::string file_ = "uniformity.json";
  std::string bytes_ = "{}\n";
};

inline v1::CreateRunRequest RigRun(const std::string& request_id) {
  v1::CreateRunRequest request;
  request.set_request_id(request_id);
  request.mutable_rig()->set_name("rig");
  request.mutable_rig()->set_camera_uri("sim:rift-s-like");
  return request;
}

inline v1::CreateJobRequest RigJob(const std::string& request_id) {
  v1::CreateJobRequest request;
  request.set_request_id(request_id);
  *request.mutable_run() = RigRun("");
  return request;
}

// Waits without a clock: the table says when to look again.
inline v1::Job AwaitJob(JobTable& table, int64_t number,
                        const std::function<bool(const v1::Job&)>& reached) {
  std::mutex mutex;
  std::condition_variable changed;
  const auto listener = table.AddListener(number, [&] {
    const std::lock_guard lock(mutex);
    changed.notify_all();
  });
  std::unique_lock lock(mutex);
  changed.wait(lock, [&] { return reached(*table.Latest(number)); });
  lock.unlock();
  table.RemoveListener(number, *listener);
  return *table.Latest(number);
}

inline v1::Job AwaitEnd(JobTable& table, int64_t number) {
  return AwaitJob(table, number, HasEnded);
}

}  // namespace eyebox::service

#endif  // EYEBOX_TESTS_SERVICE_SERVER_MANUAL_WORK_H_
