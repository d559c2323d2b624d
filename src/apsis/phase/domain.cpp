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

}  // namespace

domain::domain(phase_space space, std::vector<faces> sides)
    : space_(std::move(space)), sides_(std::move(sides)), ghosts_(sides_.size()) {
  const grid& mesh = space_.mesh;
  if (sides_.size() != at(mesh.dimensions()))
    throw input_error(
        fmt::format("{} pairs of boundaries (the mesh has {} dimensions); give one pair for each dimension",
                    sides_.size(), mesh.dimensions()));
  for (int k = 0; k < mesh.dimensions(); ++k)
    if (side({k, false}).periodic() != side({k, true}).periodic())
      throw input_error(fmt::format(
          "only one face of direction {} is periodic (its ends continue each other); make both periodic",
          k + 1));
  for (int k = 0; k < mesh.dimensions(); ++k)
    for (const bool upper : {false, true})
      if (auto own = side({k, upper}).prepared({k, upper}, space_.velocities))
        sides_[at(k)][upper ? 1 : 0] = std::move(own);
}

domain::domain() : space_(grid::line(1, 0.0, 1.0)) {}

domain domain::point() {
  return {};
}

const boundary& domain::side(const face& where) const {
  return *sides_[at(where.direction)][where.upper ? 1 : 0];
}

field& domain::ghosts(const face& where) {
  return ghosts_[at(where.direction)][where.upper ? 1 : 0];
}

const field& domain::ghosts(const face& where) const {
  return ghosts_[at(where.direction)][where.upper ? 1 : 0];
}

bool domain::periodic(int direction) const {
  return side({direction, false}).periodic();
}

std::optional<std::vector<std::vector<double>>> domain::entropy_bounds() const {
  std::vector<std::vector<double>> all;
  for (const faces& pair : sides_)
    for (const auto& one : pair) {
      if (one->periodic()) continue;
      auto bound = one->entropy_bound();
      if (!bound) return std::nullopt;
      all.push_back(std::move(*bound));
    }
  return all;
}

bool domain::repeats(const face& where) const {
  return side(where).repeated_cell(0, mesh().cells(where.direction)).has_value();
}

void domain::reserve(int components, int width) {
  for (int direction = 0; direction < static_cast<int>(sides_.size()); ++direction)
    for (const bool upper : {false, true}) {
      const face where{direction, upper};
      field& rows = ghosts(where);
      if (repeats(where) || (rows.components() == components && width_ >= width)) continue;
      rows = field(mesh().pencils(direction) * std::max(width, width_), components);
    }
  width_ = std::max(width, width_);
}

position domain::meeting_point(const face& where, int pencil) const {
  position x = mesh().centre(mesh().first_cell(where.direction, pencil));
  double& along = x[at(where.direction)];
  along -= 0.5 * mesh().spacing(where.direction);
  if (where.upper) along += mesh().spacing(where.direction) * mesh().cells(where.direction);
  return x;
}

void domain::fill_face(const face& where, double t, const field& u) {
  const int n = mesh().cells(where.direction), stride = mesh().stride(where.direction);
  field& rows = ghosts(where);
  constexpr int pencils_at_once = 16;
  parallel_blocks(mesh().pencils(where.direction), pencils_at_once, [&](int begin, int end) {
    std::vector<const double*> inside(at(n));
    std::vector<double*> beyond(at(width_));
    for (int pencil = begin; pencil < end; ++pencil) {
      const int first = mesh().first_cell(where.direction, pencil);
      for (int k = 0; k < n; ++k) inside[at(k)] = u.row(first + (where.upper ? n - 1 - k : k) * stride);
      for (int g = 0; g < width_; ++g) beyond[at(g)] = rows.row(pencil * width_ + g);
      side(where).fill(where, t,
                       {inside, beyond, space_.velocities, u.components(), meeting_point(where, pencil)});
    }
  });
}

void domain::fill_ghosts(double t, const field& u) {
  for (int direction = 0; direction < static_cast<int>(sides_.size()); ++direction)
    for (const bool upper : {false, true})
      if (const face where{direction, upper}; !repeats(where)) fill_face(where, t, u);
}

const double* domain::ghost_row(const field& u, const face& where, int pencil, int ghost) const {
  const int n = mesh().cells(where.direction);
  if (const auto cell = side(where).repeated_cell(ghost, n)) {
    const int i = where.upper ? n - 1 - *cell : *cell;
    return u.row(mesh().first_cell(where.direction, pencil) + i * mesh().stride(where.direction));
  }
  return ghosts(where).row(pencil * width_ + ghost);
}

void domain::ghost_rows(const face& where, int pencil, std::vector<const double*>& rows) const {
  rows.resize(at(width_));
  for (int g = 0; g < width_; ++g) rows[at(g)] = ghosts(where).row(pencil * width_ + g);
}

void domain::pencil_rows(const field& u, int direction, int pencil, int begin, int end,
                         std::vector<const double*>& rows) const {
  const int n = mesh().cells(direction), first = mesh().first_cell(direction, pencil),
            stride = mesh().stride(direction);
  rows.resize(at(end - begin));
  for (int i = begin; i < std::min(end, 0); ++i)
    rows[at(i - begin)] = ghost_row(u, {direction, false}, pencil, -1 - i);
  for (int i = std::max(begin, 0); i < std::min(end, n); ++i) rows[at(i - begin)] = u.row(first + i * stride);
  for (int i = std::max(begin, n); i < end; ++i)
    rows[at(i - begin)] = ghost_row(u, {direction, true}, pencil, i - n);
}

}  // namespace apsis
