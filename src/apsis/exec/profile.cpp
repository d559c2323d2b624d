#include <apsis/exec/profile.hpp>

#include <atomic>
#include <cstddef>

namespace apsis {
namespace {

struct tally {
  std::atomic<double> seconds = 0.0, numbers = 0.0, operations = 0.0, bytes = 0.0;
};

std::atomic<bool> on = false;
std::array<tally, kernel_count> tallies;

}  // namespace

const char* kernel_name(kernel which) {
  switch (which) {
    case kernel::edges:
      return "edges";
    case kernel::fluxes:
      return "fluxes";
    case kernel::multiples:
      return "multiples of u";
    case kernel::halo:
      return "halo";
    case kernel::walls:
      return "walls";
    case kernel::cut_cells:
      return "cut cells";
    case kernel::forces:
      return "forces";
    case kernel::points:
      return "Gauss points";
    case kernel::equilibria:
      return "equilibria";
    case kernel::relaxation:
      return "relaxation";
    case kernel::derivatives:
      return "derivatives";
    case kernel::correction:
      return "moment equations";
    case kernel::implicit:
      return "implicit sweeps";
    case kernel::mixture:
      return "mixture";
    case kernel::monitor:
      return "monitor";
  }
  return "";
}

void profile::start() {
  for (auto& one : tallies) one.seconds = one.numbers = one.operations = one.bytes = 0.0;
  on = true;
}

void profile::stop() {
  on = false;
}

bool profile::is_on() {
  return on.load(std::memory_order_relaxed);
}

void profile::add(kernel which, double seconds, double numbers, const kernel_work& each) {
  auto& one = tallies[static_cast<std::size_t>(which)];
  one.seconds += seconds;
  one.numbers += numbers;
  one.operations += numbers * each.operations;
  one.bytes += numbers * each.bytes;
}

std::vector<kernel_totals> profile::read() {
  std::vector<kernel_totals> done;
  for (std::size_t k = 0; k < kernel_count; ++k)
    if (tallies[k].numbers > 0.0)
      done.push_back({static_cast<kernel>(k), tallies[k].seconds, tallies[k].numbers, tallies[k].operations,
                      tallies[k].bytes});
  return done;
}

}  // namespace apsis
