#include <apsis/exec/parallel.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/core/log.hpp>
#include <apsis/exec/processors.hpp>
#include <apsis/exec/thread_team.hpp>

#include <algorithm>
#include <atomic>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <system_error>
#include <utility>

#include <fmt/format.h>

namespace apsis {
namespace {

/// Number of threads of the loops that this thread starts. It is not global: another thread of Python could
/// change a global number after a loop has prepared scratch memory for its threads.
thread_local int thread_count = 1;
std::atomic<std::size_t> fewest_shared = fewest_shared_numbers;

/// Returns the team of the calling thread, created on demand. A forked process does not use the team
/// of its parent.
thread_team& team_of(int size) {
  thread_local std::unique_ptr<thread_team> team;
  if (team && team->is_orphaned())
    static_cast<void>(team.release());  // NOLINT(bugprone-unused-return-value): of the parent process
  if (!team || team->size() != size) team = std::make_unique<thread_team>(size);
  return *team;
}

/// Runs all jobs on this thread, as thread 0.
void run_alone(int n, numbered_job job) {
  auto& here = this_thread_position();
  struct restore {
    region_position& here;
    region_position before;
    ~restore() { here = before; }
  } const after{here, here};
  here = {true, 0};
  for (int k = 0; k < n; ++k) job(k);
}

}  // namespace

void set_threads(int n) {
  if (n < 0 || n > most_threads)
    throw input_error(
        fmt::format("{} threads cannot be used (1 to {} are possible, and 0 stands for all {} "
                    "processors that this process may use); give a number in this range",
                    n, most_threads, available_processors()));
  thread_count = n > 0 ? n : std::min(available_processors(), most_threads);
}

int requested_threads() {
  const char* const text = std::getenv("OMP_NUM_THREADS");
  if (text == nullptr || *text == '\0') return 0;
  // A list has one number per nesting level of regions, the outermost first.
  const char* const end = text + std::strcspn(text, ",");
  int n = 0;
  const auto [stop, problem] = std::from_chars(text, end, n);
  if (problem == std::errc::result_out_of_range && *text != '-') return most_threads;
  if (problem == std::errc() && stop == end && n > 0) return std::min(n, most_threads);
  log::warning(fmt::format(
      "OMP_NUM_THREADS = '{}' is ignored (it is not a positive integer); give one, or unset it", text));
  return 0;
}

int default_threads() {
  const int requested = requested_threads();
  return requested > 0 ? requested : std::min(available_processors(), most_threads);
}

int threads() {
  return thread_count;
}

int threads_here() {
  return this_thread_position().inside ? 1 : threads();
}

void share_loops_from(std::size_t numbers) {
  fewest_shared = numbers;
}

loops_over::loops_over(std::size_t numbers)
    : outermost_(!this_thread_position().inside && numbers < fewest_shared) {
  if (outermost_) this_thread_position().inside = true;
}

loops_over::~loops_over() {
  if (outermost_) this_thread_position().inside = false;
}

int thread_number() {
  return this_thread_position().number;
}

void run_parallel_for(int n, numbered_job body) {
  const int team = threads_here(), together = std::min(team, n);
  if (together <= 1) return run_alone(n, body);
  thread_team& all = team_of(team);
  if (all.backs_off()) return run_alone(n, body);
  all.run(n, together, body, thread_team::split::parts);
}

part_blocks::part_blocks(int n, int longest, int parts) : n_(n), parts_(std::max(1, parts)) {
  const int length = n_ / parts_ + (n_ % parts_ != 0 ? 1 : 0);
  whole_ = std::max(1, length / longest + (length % longest != 0 ? 1 : 0));
  // Short blocks are not split, because starting a block has a cost.
  const int last = length / whole_;
  pieces_ = parts_ == 1 || last < 32 ? 1 : last < 64 ? 2 : 4;
}

int part_blocks::begin(int block) const {
  // Starts of the pieces of the last block, in eighths of the block: a half, a quarter and two eighths.
  static constexpr int eighths[] = {0, 4, 6, 7};
  const int part = block / per_part(), i = block % per_part();
  if (part == parts_) return n_;
  const int whole = std::min(i, whole_ - 1);
  const auto first = [this](int p) { return static_cast<int>(static_cast<long>(n_) * p / parts_); };
  const long cells = first(part + 1) - first(part);
  // cells (8 whole + eighths)/(8 whole_), evaluated in an order in which no product exceeds 64 bits.
  return first(part) + static_cast<int>((cells * whole + cells * eighths[i - whole] / 8) / whole_);
}

void run_parallel_tasks(int n, numbered_job body) {
  const int team = threads_here(), together = std::min(team, n);
  if (together <= 1) return run_alone(n, body);
  team_of(team).run(n, together, body, thread_team::split::one_by_one);
}

}  // namespace apsis
