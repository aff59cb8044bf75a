#include <gtest/gtest.h>

#include <atomic>
#include <numeric>
#include <stdexcept>
#include <thread>
#include <vector>

#include "s2s/mapper/worker.h"

namespace s2s::mapper {
namespace {

std::vector<int> throughWorker(bool threaded) {
  std::vector<int> seen;
  Worker worker(threaded, 3);
  for (int i = 0; i < 1000; ++i) worker.post([&seen, i] { seen.push_back(i); });
  worker.finish();
  return seen;
}

TEST(Worker, ThreadedOrNot_RunsEverythingInOrder) {
  std::vector<int> expected(1000);
  std::iota(expected.begin(), expected.end(), 0);
  EXPECT_EQ(throughWorker(false), expected);
  EXPECT_EQ(throughWorker(true), expected);
}

TEST(Worker, FullQueue_RefusesWithoutWaiting) {
  std::atomic<bool> go{false}, started{false};
  std::atomic<int> handled{0};
  Worker worker(true, 2);
  worker.post([&] {
    started = true;
    while (!go) std::this_thread::yield();
  });
  while (!started) std::this_thread::yield();  // from here on the queue is empty and the thread busy
  const auto task = [&] { ++handled; };
  EXPECT_TRUE(worker.tryPost(task));
  EXPECT_TRUE(worker.tryPost(task));
  EXPECT_FALSE(worker.tryPost(task));
  go = true;
  worker.finish();
  EXPECT_EQ(handled, 2);
}

TEST(Worker, FastProducer_WaitsForRoom) {
  std::atomic<int> handled{0};
  std::atomic<bool> go{false};
  const auto task = [&] {
    while (!go) std::this_thread::yield();
    ++handled;
  };
  Worker worker(true, 2);
  std::atomic<int> posted{0};
  std::thread producer([&] {
    for (int i = 0; i < 10; ++i) {
      worker.post(task);
      ++posted;
    }
  });
  // One task is running and two are queued, so the fourth post cannot return before `go`.
  while (posted < 3) std::this_thread::yield();
  EXPECT_LE(posted, 3);
  go = true;
  producer.join();
  worker.finish();
  EXPECT_EQ(handled, 10);
}

TEST(Worker, TaskThrows_CallerSeesTheError) {
  for (const bool threaded : {false, true}) {
    Worker worker(threaded, 2);
    EXPECT_THROW(
        {
          for (int i = 0; i < 100; ++i)
            worker.post([i] {
              if (i == 5) throw std::runtime_error("five");
            });
          worker.finish();
        },
        std::runtime_error)
        << "threaded " << threaded;
  }
}

TEST(Worker, DestroyedWithoutFinish_DoesNotHang) {
  Worker worker(true, 2);
  worker.post([] {});
}

}  // namespace
}  // namespace s2s::mapper
