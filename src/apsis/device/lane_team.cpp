#include <apsis/device/lane_team.hpp>

#include <algorithm>
#include <limits>
#include <new>
#include <numeric>
#include <stdexcept>
#include <utility>

#include <boost/context/fiber.hpp>
#include <fmt/format.h>
#include <sys/mman.h>

namespace apsis {

using boost::context::fiber;

/// The lanes as fibers, with stacks that are reused. The system provides their pages on first use.
struct lane_team::stacks {
  static constexpr std::size_t bytes = std::size_t{256} << 10;

  explicit stacks(std::size_t lanes) : contexts(lanes) {
    memory =
        mmap(nullptr, size(), PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (memory == MAP_FAILED) throw std::bad_alloc();
  }
  /// Unwinds lanes that have not ended, which use the memory.
  ~stacks() {
    contexts.clear();
    munmap(memory, size());
  }
  stacks(const stacks&) = delete;
  stacks& operator=(const stacks&) = delete;

  std::size_t size() const { return bytes * contexts.size(); }

  /// Provides the stack of a lane to its fiber, which does not free it.
  struct allocator {
    void* top;
    boost::context::stack_context allocate() const {
      boost::context::stack_context all;
      all.size = bytes;
      all.sp = top;
      return all;
    }
    void deallocate(boost::context::stack_context&) const noexcept {}
  };
  allocator of(std::size_t lane) const { return {static_cast<char*>(memory) + bytes * (lane + 1)}; }

  void* memory;
  fiber scheduler;
  std::vector<fiber> contexts;  ///< empty once their lane has ended
};

int team_lane::count() const {
  return static_cast<int>(team_->lanes_.size());
}
int team_lane::block() const {
  return team_->block_;
}
int team_lane::blocks() const {
  return team_->blocks_;
}
double* team_lane::shared() const {
  return team_->shared_.data();
}
void team_lane::wait() const {
  fiber& scheduler = team_->stacks_->scheduler;
  scheduler = std::move(scheduler).resume();
}

lane_team::lane_team(int lanes, std::size_t shared_numbers, lane_order order)
    : stacks_(std::make_unique<stacks>(static_cast<std::size_t>(lanes))),
      order_(order),
      turn_(static_cast<std::size_t>(lanes)),
      shared_(shared_numbers) {
  for (int k = 0; k < lanes; ++k) lanes_.push_back(team_lane(*this, k));
  std::iota(turn_.begin(), turn_.end(), 0);
  if (order == lane_order::backward) std::reverse(turn_.begin(), turn_.end());
}

lane_team::~lane_team() = default;

void lane_team::order_lanes() {
  if (order_ != lane_order::random) return;
  for (std::size_t k = turn_.size(); k > 1; --k) {
    // The generator of Knuth (TAOCP 2, 3.3.4): the high bits of a linear congruence.
    random_ = random_ * 6364136223846793005ul + 1442695040888963407ul;
    std::swap(turn_[k - 1], turn_[(random_ >> 33) % k]);
  }
}

/// Prepares the fiber of a lane. The lane begins when the fiber is resumed. A lane that did not end in the
/// last block is unwound before its stack is used again.
void lane_team::prepare(std::size_t lane) {
  stacks_->contexts[lane] = fiber();
  stacks_->contexts[lane] =
      fiber(std::allocator_arg, stacks_->of(lane), [this, lane](fiber&& scheduler) -> fiber {
        stacks_->scheduler = std::move(scheduler);
        (*body_)(lanes_[lane]);
        ++ended_;
        return std::move(stacks_->scheduler);
      });
}

void lane_team::run(int block, int blocks, const std::function<void(const team_lane&)>& body) {
  block_ = block;
  blocks_ = blocks;
  body_ = &body;
  ended_ = 0;
  std::fill(shared_.begin(), shared_.end(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t k = 0; k < lanes_.size(); ++k) prepare(k);
  const int all = static_cast<int>(lanes_.size());
  while (ended_ < all) {
    order_lanes();
    for (const int lane : turn_) {
      fiber& next = stacks_->contexts[static_cast<std::size_t>(lane)];
      if (next) next = std::move(next).resume();
    }
    if (ended_ > 0 && ended_ < all)
      throw std::logic_error(
          fmt::format("{} of {} lanes of a kernel wait for lanes that have ended", all - ended_, all));
  }
}

}  // namespace apsis
