#include <apsis/boundary/domain.hpp>

#include <apsis/boundary/border_of_cut_cells.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/core/index.hpp>
#include <apsis/exec/parallel.hpp>
#include <apsis/exec/profile.hpp>
#include <apsis/mesh/cut_cells.hpp>

#include <algorithm>
#include <cstddef>
#include <utility>

#include <fmt/format.h>

namespace apsis {
namespace {

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

/// Returns true if an open part of a face is part of a face of the domain.
bool is_at(const open_face& part, const face& where) {
  return part.direction == where.direction && (where.upper ? part.above : part.below) < 0;
}

}  // namespace

domain::domain(phase_space space, const std::vector<faces>& sides,
               const std::vector<std::shared_ptr<const boundary>>& solids)
    : space_(std::move(space)),
      periodic_(periodic_directions(space_.mesh, sides)),
      segments_(space_.mesh, periodic_) {
  set_sides(sides, solids);
}

domain::domain(phase_space space, const std::vector<faces>& sides,
               const std::vector<std::shared_ptr<const boundary>>& solids, const distribution& shared)
    : space_(std::move(space)),
      processes_(shared.processes),
      periodic_(periodic_directions(space_.mesh, sides)) {
  if (!processes_->is_single()) distribution_ = shared;
  segments_ = segment_table(shared.whole, mesh(), periodic_, 0);
  set_sides(sides, solids);
}

void domain::set_sides(const std::vector<faces>& sides,
                       const std::vector<std::shared_ptr<const boundary>>& solids) {
  if (solids.size() != at(mesh().obstacles()))
    throw input_error(
        fmt::format("{} boundaries of solid boxes and bodies (the mesh has {}); give one for each",
                    solids.size(), mesh().obstacles()));
  solids_ = solids;
  sides_.resize(surfaces().size());
  end_rows_.resize(surfaces().size());
  for (std::size_t number = 0; number < sides_.size(); ++number) {
    const auto& [where, solid, ends, own] = surfaces()[number];
    if (solid < 0 && periodic(where.direction)) continue;
    auto& here = sides_[number];
    if (is_border_of_cut_cells(static_cast<int>(number))) {
      here = std::make_shared<border_of_cut_cells>(where, space_.velocities);
      continue;
    }
    here = solid < 0 ? sides[at(where.direction)][where.upper ? 1 : 0] : solids[at(solid)];
    if (here->periodic())
      throw input_error("a solid box is periodic (nothing lies behind its faces); give it a wall");
    if (auto tables = here->prepared(where, space_.velocities)) here = std::move(tables);
    if (solid < 0 || budget_surfaces_.empty() || budget_surfaces_.back().solid != solid)
      budget_surfaces_.push_back({{}, where, solid});
    budget_surfaces_.back().surfaces.push_back(static_cast<int>(number));
  }
  add_cut_ends();
  for (const budget_surface& one : budget_surfaces_)
    for (const int number : one.surfaces)
      if (auto whole = sides_[at(number)]->on_surface([&] { return open_area(one); }))
        sides_[at(number)] = std::move(whole);
}

/// Sums over the whole mesh in its order, so that all processes get the same bits as a single one.
double domain::open_area(const budget_surface& one) const {
  const grid& whole = distribution_ ? distribution_->whole : mesh();
  const segment_table of_whole(whole, periodic_);
  double area = 0.0;
  for (const int number : one.surfaces) {
    const surface& here = of_whole.surfaces()[at(number)];
    for (const int end : here.segments) {
      const segment& pencil = of_whole.along(here.where.direction)[at(end)];
      position x = whole.centre(
          pencil.first + (here.where.upper ? (pencil.cells - 1) * whole.stride(here.where.direction) : 0));
      x[at(here.where.direction)] += (here.where.upper ? 0.5 : -0.5) * whole.spacing(here.where.direction);
      area += whole.face_area(here.where) * whole.radius(x);
    }
  }
  if (whole.cut() != nullptr && one.solid < 0)
    for (const open_face& part : whole.cut()->faces())
      if (is_at(part, one.where)) area += part.area * whole.radius(part.middle);
  return whole.measure() * area;
}

/// Finds the faces of the domain and the walls that belong to cut cells of this process.
void domain::add_cut_ends() {
  if (mesh().cut() == nullptr) return;
  const cut_cells& cut = *mesh().cut();
  const auto is_here = [&](int cell) { return number_in_block(cell) >= 0; };
  for (budget_surface& one : budget_surfaces_) {
    for (std::size_t f = 0; f < cut.faces().size() && one.solid < 0; ++f)
      if (const open_face& part = cut.faces()[f];
          is_at(part, one.where) && is_here(one.where.upper ? part.below : part.above))
        one.cut_faces.push_back(static_cast<int>(f));
    for (std::size_t w = 0; w < cut.walls().size() && one.solid >= 0; ++w)
      if (cut.walls()[w].solid == one.solid && is_here(cut.walls()[w].cell))
        one.walls.push_back(static_cast<int>(w));
  }
}

domain::domain() : space_(grid::line(1, 0.0, 1.0)) {}

domain domain::point() {
  return {};
}

std::optional<std::vector<std::vector<double>>> domain::entropy_bounds() const {
  std::vector<std::vector<double>> all;
  for (const budget_surface& one : budget_surfaces_) {
    auto bound = side(one.surfaces.front())->entropy_bound();
    if (!bound) return std::nullopt;
    all.push_back(std::move(*bound));
  }
  return all;
}

long domain::number_in_whole_mesh(long cell) const {
  return cell < 0 || !distribution_ ? cell : distribution_->whole.cell_of(mesh(), static_cast<int>(cell));
}

int domain::number_in_block(int cell) const {
  return distribution_ ? distribution_->number_in_block(cell) : cell;
}

std::size_t domain::ends_at(const budget_surface& one) const {
  std::size_t ends = 0;
  for (const int surface : one.surfaces) ends += at(surfaces()[at(surface)].own);
  return ends + one.cut_faces.size() + one.walls.size();
}

bool domain::repeats(int surface) const {
  return !sides_[at(surface)] || sides_[at(surface)]->cell_of_ghost(0, 1).has_value();
}

void domain::reserve(int components, int width) {
  const int before = width_;
  width_ = std::max(width, width_);
  if (distribution_ && width_ > before) {
    segments_ = segment_table(distribution_->whole, mesh(), periodic_, width_);
    halo_ = std::make_unique<halo_exchange>(*distribution_, periodic_, width_);
  }
  for (std::size_t number = 0; number < sides_.size(); ++number) {
    auto& [ghosts, beyond, inside] = end_rows_[number];
    const int ends = static_cast<int>(surfaces()[number].segments.size()), needed = ends * width_;
    if (repeats(static_cast<int>(number)) || (ghosts.components() == components && ghosts.cells() == needed))
      continue;
    ghosts = field(needed, components);
    beyond.clear();
    for (int row = 0; row < needed; ++row) beyond.push_back(ghosts.row(row));
    inside.assign(at(ends) * at(rows_inside()), nullptr);
  }
}

int domain::cell_at(int surface, int place) const {
  const auto& [where, solid, ends, own] = surfaces()[at(surface)];
  const segment& one = segment_at(where.direction, ends[at(place)]);
  return one.first + (where.upper ? (one.cells - 1) * mesh().stride(where.direction) : 0);
}

position domain::meeting_point(int surface, int place) const {
  const auto& [where, solid, ends, own] = surfaces()[at(surface)];
  const segment& one = segment_at(where.direction, ends[at(place)]);
  const auto k = at(where.direction);
  position x = mesh().centre(cell_at(surface, place));
  if (const int beyond = one.beyond[where.upper ? 1 : 0]; beyond > 0) {
    // The centre of the cell of another process, with the bits that it has there.
    const int all = distribution_->whole.cells(where.direction);
    const int along =
        mesh().first(where.direction) + one.offset + (where.upper ? one.cells - 1 + beyond : -beyond);
    x[k] = distribution_->whole.centre(
        (along % all + all) % all * distribution_->whole.stride(where.direction), where.direction);
  }
  x[k] += (where.upper ? 0.5 : -0.5) * mesh().spacing(where.direction);
  return x;
}

int domain::pencil_of(int direction, const segment& one) const {
  const int inner = mesh().stride(direction);
  return one.first / (inner * mesh().cells(direction)) * inner + one.first % inner;
}

/// Returns the number of cells from an end to the opposite one, as far as this process has their rows. A
/// pencil that continues across periodic faces is counted to the face.
int domain::visible(int direction, const segment& one, bool upper) const {
  const int seen = one.beyond[0] + one.cells + one.beyond[1];
  if (!halo_ || !periodic(direction)) return seen;
  const int n = distribution_->whole.cells(direction), first = mesh().first(direction) + one.offset;
  const int end =
      upper ? first + one.cells - 1 + one.beyond[1] : first - one.beyond[0];  // the cell at the end
  const int wrapped = (end % n + n) % n;
  return std::min(seen, upper ? wrapped + 1 : n - wrapped);
}

bool domain::prescribes_incoming(int surface, int place) const {
  const auto& [where, solid, ends, own] = surfaces()[at(surface)];
  const segment& one = segment_at(where.direction, ends[at(place)]);
  return sides_[at(surface)]->prescribes_incoming(visible(where.direction, one, where.upper), width_);
}

/// Returns the row of a cell counted inwards from an end.
const double* domain::inside_row(const field& u, int direction, const segment& one, bool upper,
                                 int cell) const {
  const int others = one.beyond[upper ? 1 : 0];
  if (cell < others) return halo_->row(u, direction, pencil_of(direction, one), upper, others - 1 - cell);
  cell -= others;
  if (cell >= one.cells) return halo_->row(u, direction, pencil_of(direction, one), !upper, cell - one.cells);
  return u.row(one.first + (upper ? one.cells - 1 - cell : cell) * mesh().stride(direction));
}

/// Returns true if the ghost rows of an end depend on cells of other processes. A boundary reads as many rows
/// inside as there are ghost rows, but at least three if the pencil has as many.
bool domain::needs_others(int direction, const segment& one, bool upper) const {
  return !one.ends_here(upper) || (one.cells < rows_inside() && visible(direction, one, upper) > one.cells);
}

void domain::fill_surface(int surface, double t, const field& u, end_kind which) {
  const auto& [where, solid, ends, own] = surfaces()[at(surface)];
  end_rows& rows = end_rows_[at(surface)];
  constexpr int ends_at_once = 16;
  const boundary& here = *sides_[at(surface)];
  const face& of_end = where;
  const std::vector<int>& segments = ends;
  parallel_blocks(static_cast<int>(segments.size()), ends_at_once, [&](int begin, int end) {
    const profile::section timed(kernel::walls, static_cast<double>(end - begin) * width_ * u.stride(),
                                 {0.0, sizeof(double)});
    for (int place = begin; place < end; ++place) {
      const segment& one = segment_at(of_end.direction, segments[at(place)]);
      if (which != end_kind::all &&
          needs_others(of_end.direction, one, of_end.upper) != (which == end_kind::of_others))
        continue;
      const int seen = std::min(visible(of_end.direction, one, of_end.upper), rows_inside());
      const std::span inside(rows.inside.data() + at(place) * at(rows_inside()), at(seen));
      const std::span beyond(rows.beyond.data() + at(place) * at(width_), at(width_));
      for (int k = 0; k < seen; ++k) inside[at(k)] = inside_row(u, of_end.direction, one, of_end.upper, k);
      here.fill(of_end, t,
                {inside, beyond, space_.velocities, u.components(), meeting_point(surface, place)});
    }
  });
}

void domain::fill_surfaces(double t, const field& u, end_kind which) {
  for (int surface = 0; surface < static_cast<int>(sides_.size()); ++surface)
    if (!repeats(surface)) fill_surface(surface, t, u, which);
}

void domain::fill_ghosts(double t, const field& u) {
  exchange(u);
  fill_surfaces(t, u, end_kind::all);
}

void domain::begin_ghosts(double t, const field& u) {
  if (halo_) halo_->begin(u);
  fill_surfaces(t, u, halo_ ? end_kind::of_own_cells : end_kind::all);
}

void domain::finish_ghosts(double t, const field& u) {
  if (!halo_) return;
  halo_->finish();
  fill_surfaces(t, u, end_kind::of_others);
}

void domain::exchange(const field& u) {
  if (!halo_) return;
  halo_->begin(u);
  halo_->finish();
}

bool domain::is_inner(const cell_box& box) const {
  for (int k = 0; k < mesh().dimensions(); ++k)
    if (splits(k) && (box.first[at(k)] < rows_inside() ||
                      box.first[at(k)] + box.cells[at(k)] > mesh().cells(k) - rows_inside()))
      return false;
  return true;
}

/// A segment that ends at a periodic face continues in another segment of its pencil, or in itself.
const double* domain::ghost_row(const field& u, int direction, int number, bool upper, int ghost) const {
  for (;;) {
    const segment& one = segment_at(direction, number);
    if (ghost < one.beyond[upper ? 1 : 0])
      return halo_->row(u, direction, pencil_of(direction, one), upper, ghost);
    ghost -= one.beyond[upper ? 1 : 0];
    const auto& [surface, place] = one.ends[upper ? 1 : 0];
    if (surface >= 0) {
      const auto repeated = sides_[at(surface)]->cell_of_ghost(ghost, visible(direction, one, upper));
      return repeated ? inside_row(u, direction, one, upper, *repeated)
                      : ghost_rows(surface, place)[at(ghost)];
    }
    const segment& next = segment_at(direction, place);
    if (ghost < next.cells)
      return u.row(next.first + (upper ? ghost : next.cells - 1 - ghost) * mesh().stride(direction));
    ghost -= next.cells;
    number = place;
  }
}

const double* domain::row_across(const field& u, int direction, int number, bool upper) const {
  const segment& one = segment_at(direction, number);
  return one.ends_here(upper) && one.ends[upper ? 1 : 0].surface >= 0
             ? nullptr
             : ghost_row(u, direction, number, upper, 0);
}

std::span<const double* const> domain::ghost_rows(int surface, int place) const {
  return {end_rows_[at(surface)].beyond.data() + at(place) * at(width_), at(width_)};
}

const double* domain::row_at(int surface, int place) const {
  return end_rows_[at(surface)].inside[at(place) * at(rows_inside())];
}

void domain::segment_rows(const field& u, int direction, int number, int begin, int end,
                          const double** rows) const {
  const segment& one = segment_at(direction, number);
  const int n = one.cells, stride = mesh().stride(direction);
  for (int i = begin; i < std::min(end, 0); ++i)
    rows[i - begin] = ghost_row(u, direction, number, false, -1 - i);
  for (int i = std::max(begin, 0); i < std::min(end, n); ++i) rows[i - begin] = u.row(one.first + i * stride);
  for (int i = std::max(begin, n); i < end; ++i)
    rows[i - begin] = ghost_row(u, direction, number, true, i - n);
}

}  // namespace apsis
