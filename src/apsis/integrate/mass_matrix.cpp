// GCC warns about the deliberately undefined register of its AVX-512 intrinsics, which Eigen uses.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif

#include <apsis/integrate/mass_matrix.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/integrate/internal/sparse_factors.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

namespace apsis {
namespace {

template <class Real>
using numbers = Eigen::Matrix<Real, Eigen::Dynamic, 1>;

template <class Real>
auto look(std::span<const Real> x) {
  return Eigen::Map<const numbers<Real>>(x.data(), static_cast<Eigen::Index>(x.size()));
}
template <class Real>
auto look(std::span<Real> x) {
  return Eigen::Map<numbers<Real>>(x.data(), static_cast<Eigen::Index>(x.size()));
}

}  // namespace

template <class Real>
struct mass_matrix<Real>::parts {
  sparse_factors<Real> factors;
  std::vector<sparsity_pattern::place> places;

  explicit parts(std::size_t n, const std::vector<entry>& entries) {
    std::vector<Eigen::Triplet<Real>> triplets;
    for (const entry& e : entries) {
      if (e.row >= n || e.column >= n)
        throw input_error(
            fmt::format("the mass matrix has an entry in row {} and column {} (it has {} rows); "
                        "count both from 0",
                        e.row, e.column, n));
      if (!std::isfinite(e.value))
        throw input_error(
            fmt::format("the mass matrix has an entry {} in row {} and column {} (it is not "
                        "finite); give real numbers",
                        static_cast<double>(e.value), e.row, e.column));
      triplets.emplace_back(static_cast<int>(e.row), static_cast<int>(e.column), e.value);
    }
    factors.entries.resize(static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(n));
    factors.entries.setFromTriplets(triplets.begin(), triplets.end());
    factors.factorize();
    for (int j = 0; j < factors.entries.outerSize(); ++j)
      for (typename sparse_factors<Real>::matrix::InnerIterator at(factors.entries, j); at; ++at)
        places.emplace_back(static_cast<std::size_t>(at.row()), static_cast<std::size_t>(j));
    // 45 roundings as for stage equations: a smaller singular value is a rounding error.
    if (!(factors.reciprocal_condition() > Real(45) * std::numeric_limits<Real>::epsilon()))
      throw input_error(
          "the mass matrix is singular to working precision (an equation without a derivative is algebraic); "
          "solve such equations for their unknowns, or differentiate them");
  }
};

template <class Real>
mass_matrix<Real>::mass_matrix(std::size_t n, const std::vector<entry>& entries) {
  if (n == 0 || n > static_cast<std::size_t>(std::numeric_limits<int>::max()))
    throw input_error(
        fmt::format("the mass matrix has {} rows (1 to {} are possible); give as many as there "
                    "are unknowns",
                    n, std::numeric_limits<int>::max()));
  parts_ = std::make_shared<const parts>(n, entries);
}

template <class Real>
mass_matrix<Real> mass_matrix<Real>::full(std::size_t n, std::span<const Real> rows) {
  if (rows.size() != n * n)
    throw input_error(
        fmt::format("the mass matrix has {} numbers (a full one of {} rows has {}); give all of them, row by "
                    "row",
                    rows.size(), n, n * n));
  std::vector<entry> entries;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j)
      if (rows[i * n + j] != Real(0)) entries.push_back({i, j, rows[i * n + j]});
  return mass_matrix(n, entries);
}

template <class Real>
std::size_t mass_matrix<Real>::size() const {
  return static_cast<std::size_t>(parts_->factors.entries.rows());
}

template <class Real>
const std::vector<sparsity_pattern::place>& mass_matrix<Real>::places() const {
  return parts_->places;
}

template <class Real>
void mass_matrix<Real>::multiply(std::span<const Real> x, std::span<Real> y) const {
  look(y).noalias() = parts_->factors.entries * look(x);
}

template <class Real>
void mass_matrix<Real>::multiply_sizes(std::span<const Real> x, std::span<Real> y) const {
  look(y).noalias() = parts_->factors.entries.cwiseAbs() * look(x);
}

template <class Real>
void mass_matrix<Real>::divide(std::span<Real> x) const {
  const numbers<Real> divided = parts_->factors.solve(look(x));
  look(x) = divided;
}

template <class Real>
std::vector<Real> mass_matrix<Real>::columns() const {
  const std::size_t n = size();
  std::vector<Real> values(n * n, Real(0));
  const Real* value = parts_->factors.entries.valuePtr();
  for (const auto& [row, column] : parts_->places) values[column * n + row] = *value++;
  return values;
}

template <class Real>
std::vector<Real> mass_matrix<Real>::at(const sparsity_pattern& pattern) const {
  std::vector<Real> values(pattern.entries(), Real(0));
  const Real* value = parts_->factors.entries.valuePtr();
  for (const auto& [row, column] : parts_->places) {
    const auto rows = pattern.rows(column);
    const auto place = std::lower_bound(rows.begin(), rows.end(), row);
    values[pattern.begin(column) + static_cast<std::size_t>(place - rows.begin())] = *value++;
  }
  return values;
}

template class mass_matrix<double>;
template class mass_matrix<long double>;

}  // namespace apsis
