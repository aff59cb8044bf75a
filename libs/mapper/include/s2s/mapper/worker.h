#pragma once

#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>

#include "s2s/mapper/bounded_queue.h"

namespace s2s::mapper {

/// Runs the tasks of a synchronous stage either at once, in the caller's thread, or in order in a thread of its own
/// behind a bounded queue.
///
/// An exception of a task reaches the caller: at once, or with the next `post` or `finish`.
class Worker {
 public:
  using Task = std::function<void()>;

  /// @param threaded false: `post` runs the task itself
  Worker(bool threaded, std::size_t capacity) : threaded_(threaded), queue_(capacity) {
    if (threaded_) thread_ = std::thread([this] { run(); });
  }
  ~Worker() {
    queue_.abandon();
    if (thread_.joinable()) thread_.join();
  }
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  void post(Task task) {
    if (!threaded_) return task();
    if (!queue_.push(std::move(task))) finish();
  }

  /// The same without waiting: false if the queue is full, and the task is not run then.
  bool tryPost(Task task) {
    if (!threaded_) {
      task();
      return true;
    }
    if (queue_.tryPush(task)) return true;
    if (queue_.closed()) finish();
    return false;
  }

  /// Waits until everything posted is done. Rethrows what a task threw. No `post` afterwards.
  void finish() {
    queue_.close();
    const std::lock_guard<std::mutex> lock(joining_);  // several producers may meet the same failure
    if (thread_.joinable()) thread_.join();
    if (const auto failure = std::exchange(failure_, nullptr)) std::rethrow_exception(failure);
  }

 private:
  void run() {
    try {
      while (const auto task = queue_.pop()) (*task)();
    } catch (...) {
      failure_ = std::current_exception();
      queue_.abandon();
    }
  }

  const bool threaded_;
  BoundedQueue<Task> queue_;
  std::mutex joining_;
  std::exception_ptr failure_;
  std::thread thread_;
};

}  // namespace s2s::mapper
