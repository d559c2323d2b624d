#include <apsis/steady/internal/alternating_directions.hpp>

#include <apsis/core/index.hpp>
#include <apsis/exec/parallel.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace apsis {
namespace {

/// Ratio of successive wave numbers. A smaller ratio saves iterations, but not time.
constexpr double ratio = 5.0;
/// The largest wave number, multiplied by the spacing of the mesh.
constexpr double shortest = 2.0;
/// Unknowns that one thread factorizes together.
constexpr int unknowns_of_a_group = 1000;

/// Returns the wave numbers from 1/extent to those of the mesh.
std::vector<double> wave_numbers(const moment_mesh& mesh) {
  const double lowest = 1.0 / mesh.extent, highest = std::max(shortest / mesh.spacing, lowest);
  const int count = alternating_directions::steps(highest / lowest);
  std::vector<double> found;
  for (int k = 0; k < count; ++k)
    found.push_back(lowest * std::pow(highest / lowest, static_cast<double>(k) / std::max(count - 1, 1)));
  return found;
}

constexpr int rows_of_a_block = 512;

/// y ← y − A x, row by row, on all threads.
void subtract_product(const row_matrix& matrix, const Eigen::VectorXd& x, Eigen::VectorXd& y) {
  parallel_blocks(static_cast<int>(matrix.rows()), rows_of_a_block, [&](int begin, int end) {
    for (int row = begin; row < end; ++row) {
      double sum = 0.0;
      for (row_matrix::InnerIterator entry(matrix, row); entry; ++entry)
        sum += entry.value() * x[entry.col()];
      y[row] -= sum;
    }
  });
}

/// Returns the solution for a right-hand side of any size, even outside the range of single precision.
Eigen::VectorXd solved_with(const sparse_factors_of<float>& factors, const Eigen::VectorXd& r) {
  const double size = r.cwiseAbs().maxCoeff();
  if (!(size > 0.0)) return Eigen::VectorXd::Zero(r.size());
  const Eigen::VectorXf scaled = (r / size).cast<float>();
  const Eigen::VectorXf solved = factors.solve(scaled);  // contiguous, as solve() requires
  return solved.cast<double>() * size;
}

/// Returns rows of Θ x for a block-diagonal Θ. `unknowns` are those of whole cells. A loop is used because
/// the blocks are too small for calls of a library.
Eigen::VectorXd scaled_rows(const std::vector<double>& scale, int moments, const Eigen::VectorXd& x,
                            const std::vector<int>& unknowns) {
  Eigen::VectorXd y(static_cast<Eigen::Index>(unknowns.size()));
  for (std::size_t k = 0; k < unknowns.size(); ++k) {
    const int row = unknowns[k];
    const double* theta = scale.data() + at(row) * at(moments);
    const double* of_cell = x.data() + row / moments * moments;
    double sum = 0.0;
    for (int j = 0; j < moments; ++j) sum += theta[j] * of_cell[j];
    y[static_cast<Eigen::Index>(k)] = sum;
  }
  return y;
}

}  // namespace

int alternating_directions::steps(double range) {
  return static_cast<int>(std::ceil(std::log(range) / std::log(ratio))) + 1;
}

alternating_directions::alternating_directions(const moment_mesh& mesh, const moment_equations& equations)
    : mesh_(mesh), conserved_(equations.conserved), matrix_(bare_matrix(mesh, equations)) {
  for (const double k : wave_numbers(mesh)) add_stage(equations, k);
  if (conserved_.empty()) return;
  const int count = static_cast<int>(conserved_.size());
  of_sources_.resize(mesh_.unknowns(), count);
  Eigen::MatrixXd sums(count, count);
  for (int k = 0; k < count; ++k) {
    Eigen::VectorXd source = Eigen::VectorXd::Zero(mesh_.unknowns());
    for (int cell = 0; cell < mesh_.cells; ++cell) source[cell * mesh_.moments + conserved_[at(k)]] = 1.0;
    of_sources_.col(k) = without_sums(source);
  }
  for (int k = 0; k < count; ++k) sums.row(k) = sums_of(of_sources_, conserved_[at(k)]);
  sums_.compute(sums);
}

Eigen::RowVectorXd alternating_directions::sums_of(const Eigen::MatrixXd& x, int moment) const {
  Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(x.cols());
  for (int cell = 0; cell < mesh_.cells; ++cell)
    sum += mesh_.volume(cell) * x.row(cell * mesh_.moments + moment);
  return sum / mesh_.cells;
}

void alternating_directions::add_stage(const moment_equations& equations, double wave_number) {
  stage added;
  added.scale.resize(equations.flights.size());
  for (std::size_t k = 0; k < added.scale.size(); ++k)
    added.scale[k] = wave_number * (equations.flights[k] + wave_number * equations.spreads[k]);
  for (int d = 0; d < mesh_.directions; ++d) added.along[at(d)] = factorized_lines(equations, d, added.scale);
  stages_.push_back(std::move(added));
}

std::vector<alternating_directions::lines> alternating_directions::factorized_lines(
    const moment_equations& equations, int direction, const std::vector<double>& scale) const {
  const int moments = mesh_.moments;
  std::vector<lines> groups;
  std::vector<std::pair<int, int>> place(at(mesh_.unknowns()));  // group and row of an unknown
  for (const line_of_cells& line : mesh_.lines[at(direction)]) {
    if (groups.empty() || static_cast<int>(groups.back().unknowns.size()) >= unknowns_of_a_group)
      groups.emplace_back();
    std::vector<int>& unknowns = groups.back().unknowns;
    for (const int cell : line)
      for (int i = 0; i < moments; ++i) {
        place[at(cell * moments + i)] = {static_cast<int>(groups.size()) - 1,
                                         static_cast<int>(unknowns.size())};
        unknowns.push_back(cell * moments + i);
      }
  }
  std::vector<std::vector<Eigen::Triplet<double>>> terms(groups.size());
  const auto add = [&](int row, int column, double value) {
    if (place[at(row)].first != place[at(column)].first) return;  // outside the line, as for cut cells
    terms[at(place[at(row)].first)].emplace_back(place[at(row)].second, place[at(column)].second, value);
  };
  const auto add_blocks = [&](const block_matrix& some, double factor) {
    for (int row = 0; row < some.rows(); ++row)
      some.visit_row(row, [&](int column, const double* block) {
        for (int i = 0; i < moments; ++i)
          for (int j = 0; j < moments; ++j)
            add(row * moments + i, column * moments + j, factor * block[i * moments + j]);
      });
  };
  add_blocks(equations.along[at(direction)], 1.0);
  add_blocks(equations.inside, 1.0 / mesh_.directions);
  for (int cell = 0; cell < mesh_.cells; ++cell)
    for (int i = 0; i < moments; ++i)
      for (int j = 0; j < moments; ++j)
        add(cell * moments + i, cell * moments + j, scale[at((cell * moments + i) * moments + j)]);
  parallel_blocks(static_cast<int>(groups.size()), 1, [&](int begin, int end) {
    for (int g = begin; g < end; ++g) {
      const auto size = static_cast<Eigen::Index>(groups[at(g)].unknowns.size());
      Eigen::SparseMatrix<double> matrix(size, size);
      matrix.setFromTriplets(terms[at(g)].begin(), terms[at(g)].end());
      groups[at(g)].factors = std::make_unique<sparse_factors_of<float>>();
      factorize(Eigen::SparseMatrix<float>(matrix.cast<float>()), *groups[at(g)].factors);
    }
  });
  return groups;
}

Eigen::VectorXd alternating_directions::without_sums(const Eigen::VectorXd& r) const {
  Eigen::VectorXd x = Eigen::VectorXd::Zero(r.size());
  for (std::size_t k = 0; k < stages_.size(); ++k) {
    Eigen::VectorXd y = r;
    if (k > 0) subtract_product(matrix_, x, y);
    for (int d = 0; d < mesh_.directions; ++d) {
      const std::vector<lines>& groups = stages_[k].along[at(d)];
      parallel_blocks(static_cast<int>(groups.size()), 1, [&](int begin, int end) {
        for (int g = begin; g < end; ++g) {
          const std::vector<int>& unknowns = groups[at(g)].unknowns;
          const Eigen::VectorXd of_lines = d > 0 ? scaled_rows(stages_[k].scale, mesh_.moments, y, unknowns)
                                                 : Eigen::VectorXd(y(unknowns));
          y(unknowns) = solved_with(*groups[at(g)].factors, of_lines);
        }
      });
    }
    x += y;
  }
  return x;
}

Eigen::VectorXd alternating_directions::solve(const Eigen::VectorXd& r) const {
  const int unknowns = mesh_.unknowns(), extra = static_cast<int>(conserved_.size());
  Eigen::VectorXd x(r.size());
  x.head(unknowns) = without_sums(r.head(unknowns));
  if (extra == 0) return x;
  Eigen::VectorXd excess(extra);
  for (int k = 0; k < extra; ++k)
    excess[k] = sums_of(x.head(unknowns), conserved_[at(k)])[0] - r[unknowns + k];
  x.tail(extra) = sums_.solve(excess);
  x.head(unknowns) -= of_sources_ * x.tail(extra);
  return x;
}

}  // namespace apsis
