// Work beside the calling thread, with a bound on what waits.
#pragma once

#include <tbb/task_group.h>

#include <atomic>
#include <utility>

namespace pb {

class TaskQueue {
 public:
  // most: tasks that wait, with the pictures that they hold.
  explicit TaskQueue(int most) : most_(most) {}

  // What waits is finished even when the caller unwinds: cells that are rendered are kept.
  ~TaskQueue() {
    try {
      group_.wait();
    } catch (...) {  // the caller is on its way out with the first failure
    }
  }
  TaskQueue(const TaskQueue&) = delete;
  TaskQueue& operator=(const TaskQueue&) = delete;

  // Both throw what a task threw.
  template <class Task>
  void run(Task task) {
    // With one thread nothing else takes tasks up: waiting here runs them.
    if (waiting_ >= most_) wait();
    ++waiting_;
    group_.run([this, task = std::move(task)] {
      task();
      --waiting_;
    });
  }

  void wait() {
    group_.wait();
    waiting_ = 0;
  }

 private:
  const int most_;
  tbb::task_group group_;
  std::atomic<int> waiting_{0};
};

}  // namespace pb
