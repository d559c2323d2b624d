#include <apsis/device/lane_team.hpp>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <system_error>

#include <fmt/format.h>
#include <sys/mman.h>
#include <ucontext.h>

namespace apsis {

/// The stacks of the lanes. The system provides their pages on first use.
struct lane_team::stacks {
  static constexpr std::size_t bytes = std::size_t{256} << 10;

  explicit stacks(std::size_t lanes) : contexts(lanes), ended(lanes) {
    memory =
        mmap(nullptr, size(), PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (memory == MAP_FAILED) throw std::bad_alloc();
  }
  ~stacks() { munmap(memory, size()); }
  stacks(const stacks&) = delete;
  stacks& operator=(const stacks&) = delete;

  std::size_t size() const { return bytes * contexts.size(); }
  void* of(std::size_t lane) const { return static_cast<char*>(memory) + bytes * lane; }

  void* memory;
  ucontext_t scheduler{};
  std::vector<ucontext_t> contexts;
  std::vector<char> ended;
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
  swapcontext(&team_->stacks_->contexts[static_cast<std::size_t>(index_)], &team_->stacks_->scheduler);
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

/// Runs the body of a lane. Contexts pass only numbers of type int, so that a pointer comes in two parts.
void lane_team::enter(unsigned high, unsigned low) {
  // NOLINTNEXTLINE(performance-no-int-to-ptr): makecontext() takes only int.
  auto* team = reinterpret_cast<lane_team*>((static_cast<std::uintptr_t>(high) << 32) | low);
  const int lane = team->running_;
  (*team->body_)(team->lanes_[static_cast<std::size_t>(lane)]);
  team->stacks_->ended[static_cast<std::size_t>(lane)] = 1;
  ++team->ended_;
}

/// Prepares the context of a lane. It is a separate function because the compiler assumes that getcontext()
/// may return more than once.
void lane_team::prepare(std::size_t lane) {
  const auto self = reinterpret_cast<std::uintptr_t>(this);
  ucontext_t& context = stacks_->contexts[lane];
  if (getcontext(&context) != 0) throw std::system_error(errno, std::generic_category());
  context.uc_stack.ss_sp = stacks_->of(lane);
  context.uc_stack.ss_size = stacks::bytes;
  context.uc_link = &stacks_->scheduler;
  makecontext(&context, reinterpret_cast<void (*)()>(&lane_team::enter), 2, static_cast<unsigned>(self >> 32),
              static_cast<unsigned>(self));
}

void lane_team::run(int block, int blocks, const std::function<void(const team_lane&)>& body) {
  block_ = block;
  blocks_ = blocks;
  body_ = &body;
  ended_ = 0;
  std::fill(shared_.begin(), shared_.end(), std::numeric_limits<double>::quiet_NaN());
  std::fill(stacks_->ended.begin(), stacks_->ended.end(), 0);
  for (std::size_t k = 0; k < lanes_.size(); ++k) prepare(k);
  const int all = static_cast<int>(lanes_.size());
  while (ended_ < all) {
    order_lanes();
    for (const int lane : turn_) {
      running_ = lane;
      swapcontext(&stacks_->scheduler, &stacks_->contexts[static_cast<std::size_t>(lane)]);
    }
    if (ended_ > 0 && ended_ < all)
      throw std::logic_error(
          fmt::format("{} of {} lanes of a kernel wait for lanes that have ended", all - ended_, all));
  }
}

}  // namespace apsis
