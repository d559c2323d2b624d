#include <apsis/phase/domain.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/exec/parallel.hpp>

#include <algorithm>
#include <cstddef>
#include <utility>

#include <fmt/format.h>

namespace apsis {
namespace {

std::size_t at(int k) {
  return static_cast<std::size_t>(k);
}

std::array<bool, 3> periodic_directions(const grid& mesh, const std::vector<domain::faces>& sides) {
  if (sides.size() != at(mesh.dimensions()))
    throw input_error(
        fmt::format("{} pairs of boundaries (the mesh has {} dimensions); give one pair for each dimension",
                    sides.size(), mesh.dimensions()));
  std::array<bool, 3> periodic{};
  for (std::size_t k = 0; k < sides.size(); ++k) {
    periodic[k] = sides[k][0]->periodic();
    if (periodic[k] != sides[k][1]->periodic())
      throw input_error(fmt::format(
          "only one face of direction {} is periodic (its ends continue each other); make both periodic",
          k + 1));
  }
  return periodic;
}

}  // namespace

domain::domain(phase_space space, std::vector<faces> sides,
               std::vector<std::shared_ptr<const boundary>> solids)
    : space_(std::move(space)),
      periodic_(periodic_directions(space_.mesh, sides)),
      segments_(space_.mesh, periodic_),
      sides_(surfaces().size()),
      ghosts_(surfaces().size()) {
  if (solids.size() != mesh().solids().size())
    throw input_error(fmt::format("{} boundaries of solid boxes (the mesh has {}); give one for each",
                                  solids.size(), mesh().solids().size()));
  for (std::size_t number = 0; number < sides_.size(); ++number) {
    const auto& [where, solid, ends] = surfaces()[number];
    if (solid < 0 && periodic(where.direction)) continue;
    auto& here = sides_[number];
    here = solid < 0 ? sides[at(where.direction)][where.upper ? 1 : 0] : solids[at(solid)];
    if (here->periodic())
      throw input_error("a solid box is periodic (nothing lies behind its faces); give it a wall");
    if (auto own = here->prepared(where, space_.velocities)) here = std::move(own);
    if (solid < 0 || openings_.empty() || openings_.back().solid != solid)
      openings_.push_back({{}, where, solid});
    openings_.back().surfaces.push_back(static_cast<int>(number));
  }
}

domain::domain() : space_(grid::line(1, 0.0, 1.0)) {}

domain domain::point() {
  return {};
}

std::optional<std::vector<std::vector<double>>> domain::entropy_bounds() const {
  std::vector<std::vector<double>> all;
  for (const opening& one : openings_) {
    auto bound = side(one.surfaces.front())->entropy_bound();
    if (!bound) return std::nullopt;
    all.push_back(std::move(*bound));
  }
  return all;
}

std::size_t domain::ends_at(const opening& one) const {
  std::size_t ends = 0;
  for (const int surface : one.surfaces) ends += surfaces()[at(surface)].segments.size();
  return ends;
}

bool domain::repeats(int surface) const {
  return !sides_[at(surface)] || sides_[at(surface)]->repeated_cell(0, 1).has_value();
}

void domain::reserve(int components, int width) {
  for (std::size_t number = 0; number < sides_.size(); ++number) {
    field& rows = ghosts_[number];
    if (repeats(static_cast<int>(number)) || (rows.components() == components && width_ >= width)) continue;
    rows = field(static_cast<int>(surfaces()[number].segments.size()) * std::max(width, width_), components);
  }
  width_ = std::max(width, width_);
}

int domain::cell_at(int surface, int place) const {
  const auto& [where, solid, ends] = surfaces()[at(surface)];
  const segment& one = segment_at(where.direction, ends[at(place)]);
  return one.first + (where.upper ? (one.cells - 1) * mesh().stride(where.direction) : 0);
}

position domain::meeting_point(int surface, int place) const {
  const face& where = surfaces()[at(surface)].where;
  position x = mesh().centre(cell_at(surface, place));
  x[at(where.direction)] += (where.upper ? 0.5 : -0.5) * mesh().spacing(where.direction);
  return x;
}

void domain::fill_surface(int surface, double t, const field& u) {
  const auto& [where, solid, ends] = surfaces()[at(surface)];
  const int stride = mesh().stride(where.direction);
  field& rows = ghosts_[at(surface)];
  constexpr int ends_at_once = 16;
  const boundary& here = *sides_[at(surface)];
  const face& of_end = where;
  const std::vector<int>& segments = ends;
  parallel_blocks(static_cast<int>(ends.size()), ends_at_once, [&](int begin, int end) {
    std::vector<const double*> inside;
    std::vector<double*> beyond(at(width_));
    for (int place = begin; place < end; ++place) {
      const segment& one = segment_at(of_end.direction, segments[at(place)]);
      inside.resize(at(one.cells));
      for (int k = 0; k < one.cells; ++k)
        inside[at(k)] = u.row(one.first + (of_end.upper ? one.cells - 1 - k : k) * stride);
      for (int g = 0; g < width_; ++g) beyond[at(g)] = rows.row(place * width_ + g);
      here.fill(of_end, t,
                {inside, beyond, space_.velocities, u.components(), meeting_point(surface, place)});
    }
  });
}

void domain::fill_ghosts(double t, const field& u) {
  for (int surface = 0; surface < static_cast<int>(sides_.size()); ++surface)
    if (!repeats(surface)) fill_surface(surface, t, u);
}

/// A segment that crosses periodic faces continues in another one of its pencil, or in itself.
const double* domain::ghost_row(const field& u, int direction, int number, bool upper, int ghost) const {
  const int stride = mesh().stride(direction);
  for (;;) {
    const segment& one = segment_at(direction, number);
    const auto& [surface, place] = one.ends[upper ? 1 : 0];
    int cell = ghost;
    if (surface < 0) {
      const segment& next = segment_at(direction, place);
      if (ghost < next.cells) return u.row(next.first + (upper ? ghost : next.cells - 1 - ghost) * stride);
      ghost -= next.cells;
      number = place;
      continue;
    }
    const auto repeated = sides_[at(surface)]->repeated_cell(ghost, one.cells);
    if (!repeated) return ghosts_[at(surface)].row(place * width_ + ghost);
    cell = *repeated;
    return u.row(one.first + (upper ? one.cells - 1 - cell : cell) * stride);
  }
}

void domain::ghost_rows(int surface, int place, std::vector<const double*>& rows) const {
  rows.resize(at(width_));
  for (int g = 0; g < width_; ++g) rows[at(g)] = ghosts_[at(surface)].row(place * width_ + g);
}

void domain::segment_rows(const field& u, int direction, int number, int begin, int end,
                          std::vector<const double*>& rows) const {
  const segment& one = segment_at(direction, number);
  const int n = one.cells, stride = mesh().stride(direction);
  rows.resize(at(end - begin));
  for (int i = begin; i < std::min(end, 0); ++i)
    rows[at(i - begin)] = ghost_row(u, direction, number, false, -1 - i);
  for (int i = std::max(begin, 0); i < std::min(end, n); ++i)
    rows[at(i - begin)] = u.row(one.first + i * stride);
  for (int i = std::max(begin, n); i < end; ++i)
    rows[at(i - begin)] = ghost_row(u, direction, number, true, i - n);
}

}  // namespace apsis
