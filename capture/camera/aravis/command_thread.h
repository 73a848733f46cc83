// One thread that does everything: Aravis' control calls belong to a single thread.
#ifndef EYEBOX_CAPTURE_CAMERA_ARAVIS_COMMAND_THREAD_H_
#define EYEBOX_CAPTURE_CAMERA_ARAVIS_COMMAND_THREAD_H_

#include <condition_variable>
#include <deque>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>

namespace eyebox::capture::aravis {

// Commands run one after another in the order of Run(). The destructor waits for the last.
class CommandThread {
 public:
  CommandThread() : thread_([this] { Loop(); }) {}
  ~CommandThread() {
    Post(nullptr);
    thread_.join();
  }
  CommandThread(const CommandThread&) = delete;
  CommandThread& operator=(const CommandThread&) = delete;

  // Runs `command` on the thread and returns what it returns. Never from within a command.
  template <typename Command>
  auto Run(Command command) -> decltype(command()) {
    // Shared: the thread may still be leaving the task when its result is here already.
    auto task = std::make_shared<std::packaged_task<decltype(command())()>>(std::move(command));
    auto result = task->get_future();
    Post([task] { (*task)(); });
    return result.get();
  }

 private:
  void Post(std::function<void()> command) {
    {
      const std::lock_guard lock(mutex_);
      commands_.push_back(std::move(command));
    }
    wake_.notify_one();
  }

  void Loop() {
    while (true) {
      std::unique_lock lock(mutex_);
      wake_.wait(lock, [this] { return !commands_.empty(); });
      const std::function<void()> command = std::move(commands_.front());
      commands_.pop_front();
      lock.unlock();
      if (!command) return;
      command();
    }
  }

  std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<std::function<void()>> commands_;
  std::thread thread_;
};

}  // namespace eyebox::capture::aravis

#endif  // EYEBOX_CAPTURE_CAMERA_ARAVIS_COMMAND_THREAD_H_
