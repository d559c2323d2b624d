// This team replaces oneTBB, whose loops of microseconds take up to 1.3 times as long on a busy machine. It
// also replaces OpenMP, which waits for preempted threads (docs/measured.md).
#include <apsis/exec/thread_team.hpp>

#include <apsis/exec/processors.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <exception>
#include <limits>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>

#include <pthread.h>
#include <signal.h>  // NOLINT(modernize-deprecated-headers): pthread_sigmask

namespace apsis {
namespace {

std::atomic<long> forks_of_this_process = 0;

/// Starts to count the forks in the ancestry of this process.
void watch_forks() {
  static const int watched = pthread_atfork(nullptr, nullptr, [] { ++forks_of_this_process; });
  static_cast<void>(watched);  // if it fails, a child process runs at the speed of one thread
}

void pause_processor() {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#elif defined(__aarch64__)
  asm volatile("yield");
#endif
}

using microseconds = std::chrono::microseconds;

/// Spins until done() or for at most `limit`, without yielding the processor; returns the last
/// value of done().
template <class Done>
bool spin_until(const Done& done, microseconds limit) {
  if (done()) return true;
  if (limit == microseconds::zero()) return false;
  const auto end = std::chrono::steady_clock::now() + limit;
  do {
    for (int k = 0; k < 16; ++k) {
      pause_processor();
      if (done()) return true;
    }
  } while (std::chrono::steady_clock::now() < end);
  return done();
}

/// The exception of the smallest k, to be rethrown after all threads have stopped.
class first_failure {
 public:
  void guard(int k, numbered_job job) {
    try {
      job(k);
    } catch (...) {
      const std::lock_guard only(mutex_);
      if (k < failed_at_) {
        failed_at_ = k;
        failure_ = std::current_exception();
      }
      any_ = true;
    }
  }
  bool any() const { return any_; }
  /// Rethrows and clears the exception, if there is one.
  void rethrow() {
    if (!any_) return;
    any_ = false;
    failed_at_ = std::numeric_limits<int>::max();
    std::rethrow_exception(std::exchange(failure_, nullptr));
  }

 private:
  std::mutex mutex_;
  std::exception_ptr failure_;
  int failed_at_ = std::numeric_limits<int>::max();
  std::atomic<bool> any_ = false;
};

/// Jobs left in the part of one thread, on a cache line of its own.
struct alignas(64) remaining {
  std::atomic<int> next = 0;
  std::atomic<bool> owned = false;  ///< the thread of this part has started
  int end = 0;

  bool any() const { return next.load(std::memory_order_relaxed) < end; }
};

/// Mailbox through which a worker is notified, on a cache line of its own.
struct alignas(64) seat {
  static constexpr int leave = -1;
  std::atomic<int> region = 0;  ///< number of the region to join, or `leave`
};

}  // namespace

/// State shared with the workers; lives until the last of them has left.
struct thread_team::shared {
  explicit shared(int workers) : seats(std::make_unique<seat[]>(static_cast<std::size_t>(workers) + 1)) {}

  // A region is open while threads may take its jobs. Its data do not change while any worker is inside.
  static constexpr int open = 1 << 30;
  alignas(64) std::atomic<int> inside = 0;  ///< number of workers inside, plus `open`

  numbered_job job{};
  split mode = split::parts;
  int n = 0, threads = 1;
  std::array<remaining, most_threads> parts;
  first_failure failure;
  std::unique_ptr<seat[]> seats;  ///< seats of workers 1, 2, …; that of the caller is unused
  microseconds spin_limit{0};     ///< time that a thread spins before it sleeps

  bool enter() {
    int now = inside.load(std::memory_order_relaxed);
    while ((now & open) != 0)
      if (inside.compare_exchange_weak(now, now + 1, std::memory_order_acquire)) return true;
    return false;
  }
  void go_out() {
    // The caller may be sleeping once the region is closed.
    if (inside.fetch_sub(1, std::memory_order_release) == 1) inside.notify_all();
  }

  /// Runs jobs of a part; returns their number.
  int take(remaining& part, int end) {
    int taken = 0;
    while (part.next.load(std::memory_order_relaxed) < end) {
      const int k = part.next.fetch_add(1, std::memory_order_relaxed);
      if (k >= part.end || (mode == split::one_by_one && failure.any())) break;
      failure.guard(k, job);
      ++taken;
    }
    return taken;
  }

  int work(int own) {
    if (mode == split::one_by_one) return take(parts[0], n);
    if (own >= threads) return 0;
    // Every thread first runs its own part, whose memory is close to it. It then steals from the others,
    // because processors may differ in speed and threads may be preempted. An owner that has started keeps
    // the last job of its part; otherwise short parts would migrate between caches.
    parts[static_cast<std::size_t>(own)].owned.store(true, std::memory_order_relaxed);
    int taken = 0;
    for (int p = 0; p < threads; ++p) {
      auto& part = parts[static_cast<std::size_t>((own + p) % threads)];
      const bool owned = p > 0 && part.owned.load(std::memory_order_relaxed);
      taken += take(part, owned ? part.end - 1 : part.end);
    }
    return taken;
  }

  /// Runs the jobs that are still left after 2 µs, because their owners are not running; returns
  /// their number.
  int work_of_others() {
    constexpr microseconds until_owner_comes(2);
    const auto nothing_left = [this] {
      return std::none_of(parts.begin(), parts.begin() + threads,
                          [](const auto& part) { return part.any(); });
    };
    int taken = 0;
    if (mode == split::parts && !spin_until(nothing_left, until_owner_comes))
      for (int p = 0; p < threads; ++p) {
        auto& part = parts[static_cast<std::size_t>(p)];
        taken += take(part, part.end);
      }
    return taken;
  }

  /// Closes the region and waits for the workers that still run a job.
  void close() {
    inside.fetch_and(~open, std::memory_order_relaxed);
    const auto alone = [this] { return inside.load(std::memory_order_acquire) == 0; };
    if (spin_until(alone, spin_limit)) return;
    for (int now = inside.load(std::memory_order_acquire); now != 0;
         now = inside.load(std::memory_order_acquire))
      inside.wait(now, std::memory_order_acquire);
  }
};

region_position& this_thread_position() {
  thread_local region_position here;
  return here;
}

thread_team::thread_team(int size)
    : size_(size), forks_(forks_of_this_process), shared_(std::make_shared<shared>(size - 1)) {
  watch_forks();
  // Spinning pays only for threads that run simultaneously.
  if (size <= available_processors()) shared_->spin_limit = microseconds(50);
  // Workers block all signals, which belong to the threads of the user.
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  try {
    for (; workers_ < size - 1; ++workers_) std::thread(serve, shared_, workers_ + 1).detach();
  } catch (const std::system_error&) {  // NOLINT(bugprone-empty-catch)
    // The caller does the work of threads that could not be started.
  }
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

void team_overhead::add(const times& at, int own, int n) {
  using seconds = std::chrono::duration<double>;
  // Debts below the limit are the cost of waking workers. Backing off for 12 debts bounds the loss to 1/13 of
  // the time.
  constexpr double limit = 2e-4, backoff_per_debt = 12.0;
  if (own == 0) return;  // the workers did everything
  const double alone = seconds(at.worked - at.called).count() * n / own;
  debt_ = std::max(debt_ + seconds(at.ended - at.begun).count() - alone, -limit);
  if (debt_ <= limit) return;
  backoff_until_ = at.ended + std::chrono::duration_cast<std::chrono::steady_clock::duration>(
                                  seconds(backoff_per_debt * debt_));
  debt_ = 0.0;
}

thread_team::~thread_team() {
  for (int worker = 1; worker <= workers_; ++worker) {
    auto& call = shared_->seats[static_cast<std::size_t>(worker)].region;
    call.store(seat::leave, std::memory_order_release);
    call.notify_one();
  }
}

bool thread_team::is_orphaned() const {
  return forks_ != forks_of_this_process;
}

void thread_team::serve(const std::shared_ptr<shared>& with, int number) {
  this_thread_position() = {true, number};
  auto& call = with->seats[static_cast<std::size_t>(number)].region;
  int last = 0;
  for (;;) {
    const auto called = [&] { return call.load(std::memory_order_acquire) != last; };
    if (!spin_until(called, with->spin_limit)) call.wait(last, std::memory_order_acquire);
    last = call.load(std::memory_order_acquire);
    if (last == seat::leave) return;
    if (!with->enter()) continue;
    with->work(number);
    with->go_out();
  }
}

void thread_team::run(int n, int threads, numbered_job job, split mode) {
  const auto begun = std::chrono::steady_clock::now();
  auto& all = *shared_;
  all.job = job;
  all.mode = mode;
  all.n = n;
  all.threads = threads;
  const int parts = mode == split::parts ? threads : 1;
  const auto first = [&](int part) { return static_cast<int>(static_cast<long>(n) * part / parts); };
  for (int p = 0; p < parts; ++p) {
    auto& part = all.parts[static_cast<std::size_t>(p)];
    part.next.store(first(p), std::memory_order_relaxed);
    part.owned.store(false, std::memory_order_relaxed);
    part.end = first(p + 1);
  }
  all.inside.store(shared::open, std::memory_order_release);
  for (int worker = 1; worker <= std::min(workers_, threads - 1); ++worker) {
    auto& call = all.seats[static_cast<std::size_t>(worker)].region;
    const int next = (call.load(std::memory_order_relaxed) + 1) & (shared::open - 1);
    call.store(next, std::memory_order_release);
    call.notify_one();
  }
  auto& here = this_thread_position();
  here = {true, 0};
  const auto called = std::chrono::steady_clock::now();
  const int own = all.work(0) + all.work_of_others();
  const auto worked = std::chrono::steady_clock::now();
  all.close();
  here = {};
  if (mode == split::parts) overhead_.add({begun, called, worked, std::chrono::steady_clock::now()}, own, n);
  all.failure.rethrow();
}

}  // namespace apsis
