// collective NAME RANK HOW: the process of this rank does not take part in a collective operation, and the
// others wait for it. HOW is one of:
// - "fails": the process fails with an error
// - "hangs": it hangs, and the next process fails
// - "is-missed": it hangs, and the others receive a signal while they wait
#include <apsis/core/errors.hpp>
#include <apsis/exec/agreement.hpp>

#include <array>
#include <chrono>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <processes.hpp>

namespace {

using apsis::communicator;
using job = std::function<void(communicator&)>;

void expect(bool right) {
  if (!right) throw std::logic_error("a wrong result");
}

void exchange_in_a_ring(communicator& all) {
  // The message is so long that it waits for its receiver.
  std::vector<double> mine(1 << 18, all.rank()), theirs(mine.size());
  const int next = (all.rank() + 1) % all.size(), last = (all.rank() + all.size() - 1) % all.size();
  const std::vector<apsis::message> sent = {{next, mine}}, received = {{last, theirs}};
  all.begin_exchange(sent, received);
  all.finish_exchange();
  expect(theirs.front() == last && theirs.back() == last);
}

void broadcast_from(int root, std::size_t length, communicator& all) {
  std::vector<std::byte> bytes(length, static_cast<std::byte>(all.rank()));
  all.broadcast(bytes, root);
  expect(bytes == std::vector(length, static_cast<std::byte>(root)));
}

void gather_bytes(std::size_t length, communicator& all) {
  const auto found = all.gather(std::vector(length, static_cast<std::byte>(all.rank())));
  expect(found.size() == (all.is_root() ? static_cast<std::size_t>(all.size()) : 0));
  for (std::size_t rank = 0; rank < found.size(); ++rank)
    expect(found[rank] == std::vector(length, static_cast<std::byte>(rank)));
}

const std::map<std::string, job> collectives = {
    {"sum",
     [](communicator& all) {
       std::array<std::int64_t, 3> words = {1, all.rank(), -all.rank()};
       all.sum(words);
       const std::int64_t n = all.size();
       expect(words == std::array<std::int64_t, 3>{n, n * (n - 1) / 2, -n * (n - 1) / 2});
     }},
    {"lowest",
     [](communicator& all) {
       std::array<double, 2> values = {1.0 + all.rank(), -1.0 * all.rank()};
       all.lowest(values);
       expect(values == std::array<double, 2>{1.0, 1.0 - all.size()});
     }},
    {"broadcast", [](communicator& all) { broadcast_from(1, 8, all); }},
    {"gather", [](communicator& all) { gather_bytes(8, all); }},
    {"broadcast-of-megabytes", [](communicator& all) { broadcast_from(2, std::size_t{1} << 22U, all); }},
    {"gather-of-megabytes", [](communicator& all) { gather_bytes(std::size_t{1} << 22U, all); }},
    {"exchange", exchange_in_a_ring},
    {"agreement", [](communicator& all) { apsis::run_collectively(all, [] {}); }},
};

volatile std::sig_atomic_t asked = 0;

extern "C" void note(int) {
  asked = 1;
}

[[noreturn]] void hang() {
  for (;;) std::this_thread::sleep_for(std::chrono::hours(1));
}

int take_part(communicator& all, const job& operation, int absent, const std::string& how) {
  std::signal(SIGTERM, note);
  all.limit_waiting([] { return asked != 0; }, 0.2);
  operation(all);  // succeeds as no process fails
  if (how != "fails" && all.rank() == absent) hang();
  if ((how == "fails" && all.rank() == absent) || (how == "hangs" && all.rank() == (absent + 1) % all.size()))
    throw apsis::numerical_error("this process fails");
  if (how == "is-missed") std::raise(SIGTERM);
  operation(all);
  return 0;
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 4 || collectives.count(arguments[1]) == 0) {
    for (const auto& [name, operation] : collectives) std::puts(name.c_str());
    return count == 1 ? 0 : 2;
  }
  const std::string how = arguments[3];
  // If all processes take their turns to fail, the machine may make them wait.
  const double patience = how == "fails" ? 60.0 : 0.5;
  try {
    return apsis::app::on_all_processes(
        [&](const std::shared_ptr<communicator>& all) {
          return take_part(*all, collectives.at(arguments[1]), std::stoi(arguments[2]), how);
        },
        patience);
  } catch (const apsis::error& failure) {
    if (!apsis::app::reports_errors()) return 0;
    std::fprintf(stderr, "error: %s\n", failure.what());
    return static_cast<int>(failure.code());
  } catch (const std::exception& failure) {
    std::fprintf(stderr, "error: %s\n", failure.what());
    return 1;
  }
}
