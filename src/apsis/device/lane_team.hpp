#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

namespace apsis {

class lane_team;

/// A lane of a kernel on the host (device/internal/lane.hpp).
class team_lane {
 public:
  int index() const { return index_; }  ///< number in the block
  int count() const;                    ///< lanes of a block
  int block() const;                    ///< number of the block
  int blocks() const;                   ///< number of blocks
  double* shared() const;               ///< memory of the block
  void wait() const;                    ///< waits for all lanes of the block

 private:
  friend class lane_team;
  team_lane(lane_team& of, int index) : team_(&of), index_(index) {}
  lane_team* team_;
  int index_;
};

/// The orders in which a team runs its lanes from one call of team_lane::wait() to the next.
enum class lane_order {
  forward,   ///< by increasing number
  backward,  ///< by decreasing number
  random     ///< in a pseudorandom order, another one each time
};

/// The lanes of a block on one thread of the host. Each lane has a stack of its own, and runs until it waits;
/// then the next lane runs. A correct kernel has the same results in every order of its lanes. A kernel in
/// which a wait() is missing has different ones.
class lane_team {
 public:
  /// Makes a team of `lanes` with shared memory for `shared_numbers` numbers, which are NaN at the beginning
  /// of every block.
  lane_team(int lanes, std::size_t shared_numbers, lane_order order);
  ~lane_team();
  lane_team(const lane_team&) = delete;             ///< not copyable
  lane_team& operator=(const lane_team&) = delete;  ///< not copyable

  /// Runs body(lane) in all lanes of block number `block` of `blocks`. Throws std::logic_error if some lanes
  /// wait while others have ended.
  void run(int block, int blocks, const std::function<void(const team_lane&)>& body);

 private:
  friend class team_lane;
  struct stacks;

  void order_lanes();
  void prepare(std::size_t lane);

  std::unique_ptr<stacks> stacks_;
  lane_order order_;
  unsigned long random_ = 1;
  std::vector<int> turn_;
  std::vector<double> shared_;
  std::vector<team_lane> lanes_;
  const std::function<void(const team_lane&)>* body_ = nullptr;
  int block_ = 0, blocks_ = 1, ended_ = 0;
};

}  // namespace apsis
