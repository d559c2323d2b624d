#include <apsis/study/limit_space.hpp>

#include <apsis/config/boundary_reader.hpp>
#include <apsis/config/discretization_of_case.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/scheme/limiter.hpp>
#include <apsis/scheme/quartic.hpp>
#include <apsis/scheme/reconstruction_registry.hpp>

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

namespace apsis {
namespace {

/// Cells beyond either end whose edge values are needed: one for the flux, one more for its limiter.
constexpr int halo = 2;

domain space_of(const case_config& config, const relaxation_model& equation) {
  if (equation.space_dimensions() == 0) return domain::point();
  if (!config.solids.empty() || !config.bodies.empty())
    throw input_error("the case has no limit scheme (it has solid boxes); remove them");
  domain made({make_mesh(config), equation.velocities()}, make_boundaries(config, make_model(config)));
  for (const budget_surface& one : made.budget_surfaces())
    if (!made.side(one.surfaces.front())->cell_of_ghost(0, 1))
      throw input_error(
          fmt::format("the case has no limit scheme (rows beyond the face '{}' are not rows of cells); use "
                      "\"periodic\" or \"outflow\" there",
                      face_names[one.where.index()]));
  return made;
}

}  // namespace

/// Rows of cells −halo−ghosts … n+halo+ghosts−1 and edge values of cells −halo … n+halo−1.
struct limit_space::pencil {
  std::vector<const double*> rows;
  std::vector<double> left_edges, right_edges;
  int first_row = 0;
  std::size_t width = 0;

  const double* row(int cell) const { return rows[static_cast<std::size_t>(cell - first_row)]; }
  std::size_t at(int cell) const { return static_cast<std::size_t>(cell + halo) * width; }
  double left(int cell, std::size_t k) const { return left_edges[at(cell) + k]; }
  double right(int cell, std::size_t k) const { return right_edges[at(cell) + k]; }
};

limit_space::limit_space(const case_config& config, const relaxation_model& equation)
    : equation_(equation), space_(space_of(config, equation)), has_space_(equation.space_dimensions() > 0) {
  if (!has_space_) return;
  if (config.space.collisions == "centres")
    throw input_error(
        "the case has no limit scheme (it is known for collisions at Gauss points and of point values); "
        "leave "
        "space.collisions out");
  const reconstruction_entry* entry = try_find_reconstruction(config.space.reconstruction);
  if (entry == nullptr) throw input_error("unknown reconstruction '" + config.space.reconstruction + "'");
  scheme_ = entry->make();
  const bool volumes = config.space.discretization == "finite-volume";
  if (!volumes && config.space.discretization != "finite-difference")
    throw input_error(
        fmt::format("the case has no limit scheme ({} is neither finite-volume nor "
                    "finite-difference); choose one of them",
                    discretization_key));
  const bool first_order = scheme_->order() == 1;
  averages_ = volumes && !first_order;
  if (config.space.limiter == limiter_choice::positivity && !first_order)
    (volumes ? limit_edges_ : limit_fluxes_) = true;
  limit_for_steps(1.0);
}

void limit_space::limit_for_steps(double share) {
  if (!has_space_) return;
  inverse_cfl_.clear();
  std::vector<double> rates(static_cast<std::size_t>(equation_.components()), 0.0);
  for (int direction = 0; direction < space_.mesh().dimensions(); ++direction) {
    const auto v = equation_.speeds(direction);
    for (std::size_t k = 0; k < rates.size(); ++k)
      rates[k] += std::abs(v[k]) / space_.mesh().spacing(direction);
  }
  const double fastest = *std::max_element(rates.begin(), rates.end());
  for (const double rate : rates)
    inverse_cfl_.push_back(
        1.0 / std::max(limiter::least_cfl_number, fastest > 0.0 ? share * (rate / fastest) : 1.0));
}

field limit_space::moments(const field& u) const {
  field omega(u.cells(), equation_.moment_count());
  for (int i = 0; i < u.cells(); ++i) equation_.moments(u.row(i), omega.row(i));
  return omega;
}

field limit_space::equilibria(const field& omega) const {
  field u(omega.cells(), equation_.components());
  for (int i = 0; i < u.cells(); ++i)
    if (!equation_.equilibrium(omega.row(i), u.row(i)))
      throw numerical_error("no local equilibrium in the limit scheme (" +
                                equation_.why_inadmissible(omega.row(i)) + "); use a smaller step",
                            {-1, std::nan(""), i, omega.row(i)[0]});
  return u;
}

limit_space::pencil limit_space::reconstruct(const field& u, int direction, int segment) const {
  pencil p;
  const int n = space_.segment_at(direction, segment).cells, ghosts = scheme_->ghost_width(),
            count = n + 2 * halo;
  p.first_row = -halo - ghosts;
  p.width = static_cast<std::size_t>(u.stride());
  space_.segment_rows(u, direction, segment, p.first_row, n + halo + ghosts, p.rows);
  p.left_edges.resize(static_cast<std::size_t>(count) * p.width);
  p.right_edges.resize(static_cast<std::size_t>(count) * p.width);
  scheme_->edges(p.rows.data() + ghosts, count, u.stride(), p.left_edges.data(), p.right_edges.data());
  return p;
}

field limit_space::equilibrium_averages(const field& u) const {
  constexpr std::array<double, 7> points = {gauss3::xi[0], gauss3::xi[1],   gauss3::xi[2], -0.5,
                                            0.5,           -lobatto4_inner, lobatto4_inner};
  const pencil p = reconstruct(u, 0, 0);
  field mean(u.cells(), u.components());
  field values(gauss3::points, u.components());
  for (int i = 0; i < u.cells(); ++i) {
    for (std::size_t k = 0; k < static_cast<std::size_t>(u.components()); ++k) {
      const double c = u.row(i)[k];
      const quartic inside(p.row(i - 1)[k], c, p.row(i + 1)[k], p.left(i, k), p.right(i, k));
      double lowest = c;
      for (const double xi : points) lowest = std::min(lowest, inside(xi));
      const double theta = limit_edges_ ? limiter::scaling(c, lowest) : 1.0;
      for (int q = 0; q < gauss3::points; ++q)
        values.row(q)[k] = c + theta * inside.deviation(gauss3::xi[static_cast<std::size_t>(q)]);
    }
    const field at_points = equilibria(moments(values));
    for (int q = 0; q < gauss3::points; ++q)
      for (int k = 0; k < u.components(); ++k)
        mean.row(i)[k] += gauss3::weight[static_cast<std::size_t>(q)] * at_points.row(q)[k];
  }
  return mean;
}

double limit_space::limiter_coefficient(const pencil& p, int cell, std::size_t k, bool ahead) const {
  const int upstream = ahead ? cell - 1 : cell + 1;
  const double here = p.row(cell)[k], before = p.row(upstream)[k];
  const double in = ahead ? p.right(upstream, k) : p.left(upstream, k);
  const double out = ahead ? p.right(cell, k) : p.left(cell, k);
  return limiter::limiter_coefficient(before, here, in - limiter::low_order_edge(before),
                                      out - limiter::low_order_edge(here), inverse_cfl_[k]);
}

/// Returns the upwind value of component k at the face between cells `face` − 1 and `face`.
double limit_space::face_value(const pencil& p, int face, std::size_t k, bool ahead) const {
  const int donor = ahead ? face - 1 : face, receiver = ahead ? face : face - 1;
  const double average = p.row(donor)[k];
  const double edge = ahead ? p.right(donor, k) : p.left(donor, k);
  if (limit_fluxes_) {
    const double low_order = limiter::low_order_edge(average);
    const int harmed = edge > low_order ? donor : receiver;
    return low_order + limiter_coefficient(p, harmed, k, ahead) * (edge - low_order);
  }
  if (limit_edges_) {
    const double l = p.left(donor, k), r = p.right(donor, k);
    const double lowest = std::min(std::min(l, r), limiter::interior(average, l, r));
    return average + limiter::scaling(average, lowest) * (edge - average);
  }
  return edge;
}

void limit_space::add_divergence(const field& u, int direction, int segment, field& t) const {
  const pencil p = reconstruct(u, direction, segment);
  const apsis::segment& line = space_.segment_at(direction, segment);
  const int first = line.first, n = line.cells;
  const auto v = equation_.speeds(direction);
  std::vector<double> before(v.size()), after(v.size());
  const auto fluxes = [&](int face, std::vector<double>& flux) {
    for (std::size_t k = 0; k < v.size(); ++k) flux[k] = v[k] * face_value(p, face, k, v[k] > 0.0);
  };
  fluxes(0, before);
  for (int i = 0; i < n; ++i) {
    fluxes(i + 1, after);
    double* row = t.row(first + i * space_.mesh().stride(direction));
    for (std::size_t k = 0; k < v.size(); ++k)
      row[k] -= (after[k] - before[k]) / space_.mesh().spacing(direction);
    std::swap(before, after);
  }
}

field limit_space::transport(const field& u) const {
  field t(u.cells(), u.components());
  if (equation_.has_source())
    for (int i = 0; i < u.cells(); ++i) equation_.source(u.row(i), t.row(i));
  for (int direction = 0; has_space_ && direction < space_.mesh().dimensions(); ++direction)
    for (std::size_t s = 0; s < space_.segments().along(direction).size(); ++s)
      add_divergence(u, direction, static_cast<int>(s), t);
  return t;
}

}  // namespace apsis
