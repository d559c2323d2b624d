// collective NAME RANK: the process of this rank fails before a collective operation for which the others
// wait.
#include <apsis/core/errors.hpp>
#include <apsis/exec/agreement.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <processes.hpp>

namespace {

using apsis::communicator;
using job = std::function<void(communicator&)>;

void exchange_in_a_ring(communicator& all) {
  // Long enough for a message that waits for its receiver.
  std::vector<double> mine(1 << 18, 1.0), theirs(mine.size());
  const int next = (all.rank() + 1) % all.size(), last = (all.rank() + all.size() - 1) % all.size();
  const std::vector<apsis::message> sent = {{next, mine}}, received = {{last, theirs}};
  all.begin_exchange(sent, received);
  all.finish_exchange();
}

const std::map<std::string, job> collectives = {
    {"sum",
     [](communicator& all) {
       std::array<std::int64_t, 3> words{};
       all.sum(words);
     }},
    {"lowest",
     [](communicator& all) {
       std::array<double, 1> values{};
       all.lowest(values);
     }},
    {"broadcast",
     [](communicator& all) {
       std::array<std::byte, 8> bytes{};
       all.broadcast(bytes, 1);
     }},
    {"gather",
     [](communicator& all) {
       const std::array<std::byte, 8> bytes{};
       all.gather(bytes);
     }},
    {"exchange", exchange_in_a_ring},
    {"agreement", [](communicator& all) { apsis::together(all, [] {}); }},
};

}  // namespace

int main(int count, char** arguments) {
  if (count != 3 || collectives.count(arguments[1]) == 0) {
    for (const auto& [name, operation] : collectives) std::puts(name.c_str());
    return count == 1 ? 0 : 2;
  }
  const int failing = std::stoi(arguments[2]);
  constexpr double patience = 0.5;
  try {
    return apsis::app::on_all_processes(
        [&](const std::shared_ptr<communicator>& all) {
          const job& operation = collectives.at(arguments[1]);
          operation(*all);  // works while nobody fails
          if (all->rank() == failing) throw apsis::numerical_error("this process fails");
          operation(*all);
          return 0;
        },
        patience);
  } catch (const std::exception& failure) {
    std::fprintf(stderr, "error: %s\n", failure.what());
    return 1;
  }
}
