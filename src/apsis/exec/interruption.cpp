#include <apsis/exec/interruption.hpp>

#include <chrono>
#include <utility>

namespace apsis {
namespace {

using clock = std::chrono::steady_clock;

thread_local interruptible* innermost = nullptr;
thread_local clock::time_point next_check;

}  // namespace

interrupted_error::interrupted_error()
    : error(exit_code::interrupted,
            "interrupted before the first step (there is nothing to save); run again") {}

interruptible::interruptible(std::function<void()> check)
    : check_(std::move(check)), outer_(std::exchange(innermost, this)) {
  next_check = {};
}

interruptible::~interruptible() {
  innermost = outer_;
}

void interruptible::poll() {
  if (innermost == nullptr) return;
  const clock::time_point now = clock::now();
  if (now < next_check) return;
  next_check = now + std::chrono::milliseconds(50);
  innermost->check_();
}

}  // namespace apsis
