#include <apsis/run/whole_budget.hpp>

#include <apsis/exec/global_sum.hpp>
#include <apsis/semidiscrete/force_losses.hpp>

#include <algorithm>
#include <cstddef>
#include <map>
#include <span>
#include <utility>

namespace apsis {
namespace {

/// Stand for the surface in the key of an end in a cut cell.
constexpr int cut_face = -1, wall = -2;

/// Identifies an end of a segment by its surface, and by the number in the whole mesh of the cell in front of
/// it. Identifies an end in a cut cell by its kind and its number.
using end_key = std::pair<int, int>;

/// Returns the ends of a domain in the order of the budget.
std::vector<end_key> ends_of(const domain& space, const grid& whole) {
  std::vector<end_key> ends;
  for (const budget_surface& one : space.budget_surfaces()) {
    for (const int surface : one.surfaces)
      for (int place = 0; place < space.surfaces()[static_cast<std::size_t>(surface)].own; ++place)
        ends.emplace_back(surface, whole.cell_of(space.mesh(), space.cell_at(surface, place)));
    for (const int number : one.cut_faces) ends.emplace_back(cut_face, number);
    for (const int number : one.walls) ends.emplace_back(wall, number);
  }
  return ends;
}

/// Returns the indices that the ends of this process have in the whole mesh.
std::vector<std::size_t> places_of(const run_setup& setup) {
  const grid& whole = setup.whole_mesh();
  std::map<end_key, std::size_t> places;
  for (const end_key& one : ends_of(setup.builder().whole_space(), whole)) places.emplace(one, places.size());
  std::vector<std::size_t> mine;
  for (const end_key& one : ends_of(setup.builder().space(), whole)) mine.push_back(places.at(one));
  return mine;
}

/// Returns the number of totals that follow the amounts of the ends. Force, rotation of axisymmetric flow and
/// source have one set of totals each. A force also has its losses at the ends of the velocities.
std::size_t size_of_totals(const run_setup& setup) {
  return (setup.open_faces().size() - setup.builder().space().budget_surfaces().size()) *
             setup.equation->invariants().size() +
         (setup.config().force.acceleration ? force_losses::size(setup.equation->invariants().size()) : 0);
}

}  // namespace

std::size_t size_of_whole_budget(const run_setup& setup) {
  if (!setup.has_space()) return 0;
  const domain& whole = setup.builder().whole_space();
  return ends_of(whole, setup.whole_mesh()).size() * setup.equation->invariants().size() +
         size_of_totals(setup);
}

std::vector<double> whole_ends(const run_setup& setup, const std::vector<double>& own, std::size_t count) {
  if (setup.processes().is_single()) return own;
  const std::vector<std::size_t> mine = places_of(setup);
  std::vector<double> packed;  // for each end its index, then its values
  for (std::size_t k = 0; k < mine.size(); ++k) {
    packed.push_back(static_cast<double>(mine[k]));
    packed.insert(packed.end(), own.begin() + static_cast<std::ptrdiff_t>(k * count),
                  own.begin() + static_cast<std::ptrdiff_t>((k + 1) * count));
  }
  std::vector<double> whole(ends_of(setup.builder().whole_space(), setup.whole_mesh()).size() * count);
  const std::vector<double> all = gather_numbers(setup.processes(), packed);
  for (std::size_t from = 0; from < all.size(); from += 1 + count)
    std::copy_n(all.begin() + static_cast<std::ptrdiff_t>(from) + 1, count,
                whole.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(all[from]) * count));
  setup.processes().broadcast(std::as_writable_bytes(std::span(whole)));
  return whole;
}

std::vector<double> whole_budget(const run_setup& setup, const std::vector<double>& own) {
  if (setup.processes().is_single()) return own;
  // A process without ends has no amounts, even if others have some.
  if (global_count(setup.processes(), own.empty() ? 0 : 1) == 0) return {};
  std::vector<double> whole = whole_ends(setup, own, setup.equation->invariants().size());
  // Totals are those of the root.
  std::vector<double> totals(size_of_totals(setup));
  if (!own.empty()) std::copy_n(own.rbegin(), totals.size(), totals.rbegin());
  setup.processes().broadcast(std::as_writable_bytes(std::span(totals)));
  whole.insert(whole.end(), totals.begin(), totals.end());
  return whole;
}

std::vector<double> own_budget(const run_setup& setup, const std::vector<double>& whole) {
  if (setup.processes().is_single() || whole.empty()) return whole;
  const std::size_t count = setup.equation->invariants().size();
  std::vector<double> own;
  for (const std::size_t place : places_of(setup))
    own.insert(own.end(), whole.begin() + static_cast<std::ptrdiff_t>(place * count),
               whole.begin() + static_cast<std::ptrdiff_t>((place + 1) * count));
  const auto totals = static_cast<std::ptrdiff_t>(size_of_totals(setup));
  own.insert(own.end(), whole.end() - totals, whole.end());
  if (!setup.processes().is_root()) std::fill(own.end() - totals, own.end(), 0.0);
  return own;
}

}  // namespace apsis
