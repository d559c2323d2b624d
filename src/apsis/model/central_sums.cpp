#include <apsis/model/central_sums.hpp>

#include <apsis/exec/aligned.hpp>
#include <apsis/model/grid_sums.hpp>
#include <apsis/model/maxwellian.hpp>

#include <algorithm>
#include <tuple>

namespace apsis {
namespace {

/// all ← the weights of direction k times c^p for p = 0 … degree, one p after the other.
void find_powers(const velocity_grid& grid, int k, double u, int degree, aligned_vector<double>& all) {
  const velocity_line& line = grid.line(k);
  const auto n = static_cast<std::size_t>(line.points()), count = static_cast<std::size_t>(degree) + 1;
  all.resize(count * n);
  if (grid.uniform()) {
    std::fill_n(all.begin(), n, 1.0);
  } else {
    std::copy(line.weights().begin(), line.weights().end(), all.begin());
  }
  const double* v = line.v().data();
  for (std::size_t p = 1; p < count; ++p) {
    const double* before = all.data() + (p - 1) * n;
    double* power = all.data() + p * n;
#pragma omp simd
    for (std::size_t j = 0; j < n; ++j) power[j] = before[j] * (v[j] - u);
  }
}

}  // namespace

central_sums::central_sums(const velocity_grid& grid, const double* g, const double* u, int degree) {
  if (degree < static_cast<int>(std::tuple_size_v<grid_sums::powers>)) {
    add<grid_sums::powers>(grid, g, u, degree);
  } else {
    add<grid_sums::six_powers>(grid, g, u, degree);
  }
}

template <class Powers>
void central_sums::add(const velocity_grid& grid, const double* g, const double* u, int degree) {
  thread_local aligned_vector<double> first, second, planes;
  std::array<Powers, grid_sums::most_functions> sums;  // NOLINT(cppcoreguidelines-pro-type-member-init)
  const auto most = static_cast<std::size_t>(degree);
  if (grid.dimensions() == 1) {
    constexpr double one = 1.0;
    grid_sums::sum(last_axis(grid), 1, g, u[0], &one, 1, sums.data());
    for (std::size_t p = 0; p <= most; ++p) of_[p][0][0] = grid.weight() * sums[0][p];
    return;
  }
  if (grid.is_polar()) return add_on_rings(grid, g, u, degree);
  find_powers(grid, 0, u[0], degree, first);
  if (grid.dimensions() == 2) {
    grid_sums::sum(last_axis(grid), grid.lines(), g, u[1], first.data(), degree + 1, sums.data());
    for (std::size_t p = 0; p <= most; ++p)
      for (std::size_t q = 0; p + q <= most; ++q) of_[p][q][0] = grid.weight() * sums[p][q];
    return;
  }
  const int rows = grid.line(0).points(), lines = grid.line(1).points(), plane = grid.size() / rows;
  planes.resize((most + 1) * static_cast<std::size_t>(plane));
  grid_sums::sum_lines(g, rows, plane, first.data(), degree + 1, planes.data());
  find_powers(grid, 1, u[1], degree, second);
  for (std::size_t p = 0; p <= most; ++p) {
    grid_sums::sum(last_axis(grid), lines, planes.data() + p * static_cast<std::size_t>(plane), u[2],
                   second.data(), static_cast<int>(most - p) + 1, sums.data());
    for (std::size_t q = 0; p + q <= most; ++q)
      for (std::size_t r = 0; p + q + r <= most; ++r) of_[p][q][r] = grid.weight() * sums[q][r];
  }
}

/// For each p, one pass over the row sums all powers c_1^p c_2^q c_3^r. c_3 is the component along the axis.
void central_sums::add_on_rings(const velocity_grid& grid, const double* g, const double* u, int degree) {
  const auto n = static_cast<std::size_t>(grid.lines()), most = static_cast<std::size_t>(degree);
  const auto first = static_cast<std::size_t>(grid.component_across(0)),
             second = static_cast<std::size_t>(grid.component_across(1)),
             last = static_cast<std::size_t>(grid.last_component());
  thread_local aligned_vector<double> factors;
  factors.resize((most + 1) * n);
  std::array<grid_sums::six_powers, grid_sums::most_functions> sums;  // NOLINT
  for (std::size_t p = 0; p <= most; ++p) {
    for (std::size_t l = 0; l < n; ++l) {
      double power = grid.functions_of_lines()[l];
      for (std::size_t k = 0; k < p; ++k) power *= grid.component_of_lines(0)[l] - u[first];
      for (std::size_t q = 0; p + q <= most; ++q) {
        factors[q * n + l] = power;
        power *= grid.component_of_lines(1)[l] - u[second];
      }
    }
    grid_sums::sum(last_axis(grid), grid.lines(), g, u[last], factors.data(), static_cast<int>(most - p) + 1,
                   sums.data());
    for (std::size_t q = 0; p + q <= most; ++q)
      for (std::size_t r = 0; p + q + r <= most; ++r) {
        exponents of{};
        of[first] = p;
        of[second] = q;
        of[last] = r;
        of_[of[0]][of[1]][of[2]] = sums[q][r];
      }
  }
}

}  // namespace apsis
