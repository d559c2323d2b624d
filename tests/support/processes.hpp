#pragma once

#include <apsis/exec/communicator.hpp>

#include <algorithm>
#include <condition_variable>
#include <cstring>
#include <deque>
#include <exception>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

/// "Processes" that are threads of the test. They have the same collective calls without MPI. If a process
/// ends with an exception while others wait for it, the others fail.
namespace threads_as_processes {

class group {
 public:
  explicit group(int size) : size_(size), slots_(static_cast<std::size_t>(size)) {}
  int size() const { return size_; }

  /// Every process passes a pointer. combine(pointers) runs once, between two barriers.
  template <class Combine>
  void meet(int rank, void* mine, const Combine& combine) {
    std::unique_lock lock(mutex_);
    slots_[static_cast<std::size_t>(rank)] = mine;
    const long turn = turn_;
    if (++arrived_ == size_) {
      combine(slots_);
      arrived_ = 0;
      ++turn_;
      changed_.notify_all();
    } else {
      changed_.wait(lock, [&] { return turn_ != turn || broken_; });
      if (turn_ == turn) throw std::runtime_error("another process has ended");
    }
  }
  void send(int from, int to, std::vector<double> numbers) {
    const std::lock_guard lock(mutex_);
    mail_[{from, to}].push_back(std::move(numbers));
    changed_.notify_all();
  }
  std::vector<double> receive(int from, int to) {
    std::unique_lock lock(mutex_);
    auto& box = mail_[{from, to}];
    changed_.wait(lock, [&] { return !box.empty() || broken_; });
    if (box.empty()) throw std::runtime_error("another process has ended");
    std::vector<double> numbers = std::move(box.front());
    box.pop_front();
    return numbers;
  }
  void end_all() {
    const std::lock_guard lock(mutex_);
    broken_ = true;
    changed_.notify_all();
  }

 private:
  int size_, arrived_ = 0;
  long turn_ = 0;
  bool broken_ = false;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<void*> slots_;
  std::map<std::pair<int, int>, std::deque<std::vector<double>>> mail_;
};

class member final : public apsis::communicator {
 public:
  member(std::shared_ptr<group> all, int rank) : all_(std::move(all)), rank_(rank) {}
  int rank() const override { return rank_; }
  int size() const override { return all_->size(); }
  bool all_call_within(double) override { return true; }
  bool end_together(const std::exception_ptr&, double) override { return true; }
  [[noreturn]] void abort(int) const override { throw std::runtime_error("aborted"); }

 private:
  template <class T, class Combine>
  void reduce(std::span<T> values, const Combine& combine) {
    all_->meet(rank_, &values, [&](const std::vector<void*>& all) {
      std::span<T>& first = *static_cast<std::span<T>*>(all.front());
      for (std::size_t r = 1; r < all.size(); ++r)
        for (std::size_t k = 0; k < first.size(); ++k)
          first[k] = combine(first[k], (*static_cast<std::span<T>*>(all[r]))[k]);
      for (std::size_t r = 1; r < all.size(); ++r)
        std::copy(first.begin(), first.end(), static_cast<std::span<T>*>(all[r])->begin());
    });
  }
  void do_sum(std::span<std::int64_t> values) override {
    reduce(values, [](std::int64_t a, std::int64_t b) { return a + b; });
  }
  void do_lowest(std::span<double> values) override {
    reduce(values, [](double a, double b) { return std::min(a, b); });
  }
  void do_broadcast(std::span<std::byte> values, int from) override {
    all_->meet(rank_, &values, [&](const std::vector<void*>& all) {
      const auto& source = *static_cast<std::span<std::byte>*>(all[static_cast<std::size_t>(from)]);
      for (void* one : all) {
        auto& to = *static_cast<std::span<std::byte>*>(one);
        if (to.data() != source.data()) std::copy(source.begin(), source.end(), to.begin());
      }
    });
  }
  std::vector<std::vector<std::byte>> do_gather(std::span<const std::byte> values) override {
    std::pair<std::span<const std::byte>, std::vector<std::vector<std::byte>>> mine{values, {}};
    all_->meet(rank_, &mine, [&](const std::vector<void*>& all) {
      auto& root = *static_cast<decltype(mine)*>(all.front());
      for (void* one : all) {
        const auto& part = static_cast<decltype(mine)*>(one)->first;
        root.second.emplace_back(part.begin(), part.end());
      }
    });
    return std::move(mine.second);
  }
  void do_begin_exchange(std::span<const apsis::message> sent,
                         std::span<const apsis::message> received) override {
    for (const auto& one : sent) all_->send(rank_, one.rank, {one.numbers.begin(), one.numbers.end()});
    expected_.assign(received.begin(), received.end());
  }
  void do_finish_exchange() override {
    for (const auto& one : expected_) {
      const std::vector<double> numbers = all_->receive(one.rank, rank_);
      if (numbers.size() != one.numbers.size()) throw std::runtime_error("a message has another length");
      std::copy(numbers.begin(), numbers.end(), one.numbers.begin());
    }
    expected_.clear();
  }

  std::shared_ptr<group> all_;
  int rank_;
  std::vector<apsis::message> expected_;
};

/// Runs body(communicator) on `count` processes. Rethrows the exception of the first that failed.
template <class Body>
void run(int count, const Body& body) {
  const auto all = std::make_shared<group>(count);
  std::vector<std::exception_ptr> failures(static_cast<std::size_t>(count));
  std::vector<std::thread> threads;
  for (int rank = 0; rank < count; ++rank)
    threads.emplace_back([&, rank] {
      try {
        body(std::make_shared<member>(all, rank));
      } catch (...) {
        failures[static_cast<std::size_t>(rank)] = std::current_exception();
        all->end_all();
      }
    });
  for (auto& one : threads) one.join();
  for (const auto& failure : failures)
    if (failure) std::rethrow_exception(failure);
}

}  // namespace threads_as_processes
