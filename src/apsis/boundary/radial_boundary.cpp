#include <apsis/boundary/radial_boundary.hpp>

#include <apsis/core/errors.hpp>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>

namespace apsis {
namespace {

/// A number of cells that suffices for all ghost rows.
constexpr int many_cells = std::numeric_limits<int>::max();

/// Rows of scratch memory of this thread.
class scratch_rows {
 public:
  scratch_rows(std::size_t count, std::size_t width) : width_(width) {
    if (memory().size() < count * width) memory().resize(count * width);
  }
  double* operator[](std::size_t k) const { return memory().data() + k * width_; }

 private:
  static std::vector<double>& memory() {
    thread_local std::vector<double> all;
    return all;
  }
  std::size_t width_;
};

void multiply(const double* row, double factor, int n, double* to) {
  for (int k = 0; k < n; ++k) to[k] = factor * row[k];
}

void divide(const double* row, double by, int n, double* to) {
  for (int k = 0; k < n; ++k) to[k] = row[k] / by;
}

/// A wall with any normal in axisymmetric flow.
class radial_wall final : public oblique_wall {
 public:
  radial_wall(std::shared_ptr<const oblique_wall> of, int radial, int components)
      : of_(std::move(of)), radial_(radial), components_(components) {}

  void emit(const wall_point& where, const double* inward, const double* arriving,
            double* values) const override {
    const double r = where.at[static_cast<std::size_t>(radial_)];
    const scratch_rows scratch(1, static_cast<std::size_t>(components_));
    divide(arriving, r, components_, scratch[0]);
    of_->emit(where, inward, scratch[0], values);
    multiply(values, r, components_, values);
  }

  std::array<double, 3> velocity(const wall_point& where) const override { return of_->velocity(where); }

 private:
  std::shared_ptr<const oblique_wall> of_;
  int radial_, components_;
};

}  // namespace

radial_boundary::radial_boundary(std::shared_ptr<const boundary> of, int radial, double spacing)
    : of_(std::move(of)), radial_(radial), spacing_(spacing) {}

std::shared_ptr<const boundary> radial_boundary::prepared(const face& where,
                                                          const velocity_set& velocities) const {
  auto own = std::make_shared<radial_boundary>(*this);
  own->crosses_ = where.direction == radial_;
  own->components_ = velocities.components();
  if (own->crosses_ && !of_->prescribes_incoming(many_cells, 1) && !of_->cell_of_ghost(0, 1))
    throw input_error(
        "a boundary with mirror images at r = const (a cylinder is no plane of symmetry); use a wall, such "
        "as "
        "'diffuse', with accommodation = 0 for specular reflection");
  if (auto tables = of_->prepared(where, velocities)) own->of_ = std::move(tables);
  return own;
}

std::shared_ptr<const boundary> radial_boundary::on_surface(const std::function<double()>& area) const {
  auto side = of_->on_surface(area);
  if (!side) return nullptr;
  auto own = std::make_shared<radial_boundary>(*this);
  own->of_ = std::move(side);
  return own;
}

std::shared_ptr<const oblique_wall> radial_boundary::oblique(const velocity_set& velocities) const {
  auto wall = of_->oblique(velocities);
  return wall ? std::make_shared<radial_wall>(std::move(wall), radial_, velocities.components()) : nullptr;
}

/// Where r changes, a ghost row with the repeated f differs from the repeated row of F.
std::optional<int> radial_boundary::cell_of_ghost(int ghost, int cells) const {
  return crosses_ ? std::nullopt : of_->cell_of_ghost(ghost, cells);
}

/// Returns r of a ghost row over r of a cell, 0 for a ghost row below the axis.
double radial_boundary::ratio_of_radii(const face& where, const position& at, int ghost, int cell) const {
  const double outward = where.upper ? spacing_ : -spacing_, r = radius(at);
  return std::max(r + outward * (ghost + 0.5), 0.0) / (r - outward * (cell + 0.5));
}

double radial_boundary::multiple_of_cell(const face& where, const position& at, int cells) const {
  const double of_f = of_->multiple_of_cell(where, at, cells);
  return crosses_ ? of_f * ratio_of_radii(where, at, 0, 0) : of_f;
}

void radial_boundary::fill(const face& where, double t, const pencil_end& rows) const {
  const int cells = static_cast<int>(rows.inside.size());
  if (!crosses_ || !of_->cell_of_ghost(0, cells)) return of_->fill(where, t, rows);
  for (std::size_t g = 0; g < rows.ghosts.size(); ++g) {
    const int ghost = static_cast<int>(g), cell = *of_->cell_of_ghost(ghost, cells);
    multiply(rows.inside[static_cast<std::size_t>(cell)], ratio_of_radii(where, rows.at, ghost, cell),
             rows.components, rows.ghosts[g]);
  }
}

void radial_boundary::incoming(const face& where, double t, const position& at, const double* outgoing,
                               double* values) const {
  const scratch_rows scratch(1, static_cast<std::size_t>(components_));
  divide(outgoing, radius(at), components_, scratch[0]);
  of_->incoming(where, t, at, scratch[0], values);
  multiply(values, radius(at), components_, values);
}

void radial_boundary::incoming_given_outgoing(const face& where, double t, const position& at,
                                              const double* outgoing, std::span<const double* const> ghosts,
                                              double* values) const {
  const double r = radius(at);
  const scratch_rows scratch(ghosts.size() + 1, static_cast<std::size_t>(components_));
  thread_local std::vector<const double*> of_f;
  of_f.clear();
  for (std::size_t g = 0; g < ghosts.size(); ++g) {
    divide(ghosts[g], r, components_, scratch[g + 1]);
    of_f.push_back(scratch[g + 1]);
  }
  divide(outgoing, r, components_, scratch[0]);
  of_->incoming_given_outgoing(where, t, at, scratch[0], of_f, values);
  multiply(values, r, components_, values);
}

}  // namespace apsis
