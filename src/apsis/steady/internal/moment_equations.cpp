#include <apsis/steady/internal/moment_equations.hpp>

#include <apsis/core/index.hpp>

#include <cstddef>

namespace apsis {

std::vector<line_of_cells> lines_along(const cell_links& links, int direction,
                                       const std::vector<int>& number) {
  std::vector<line_of_cells> found;
  std::vector<bool> visited(number.size(), false);
  const auto follow = [&](int cell) {
    line_of_cells& line = found.emplace_back();
    for (; cell >= 0 && !visited[at(cell)]; cell = links.next_or_image(direction, true, cell)) {
      visited[at(cell)] = true;
      line.push_back(number[at(cell)]);
    }
  };
  for (const int cell : links.cells())
    if (links.next_or_image(direction, false, cell) < 0) follow(cell);
  for (const int cell : links.cells())  // periodic lines have no end
    if (!visited[at(cell)]) follow(cell);
  return found;
}

moment_equations::moment_equations(const moment_mesh& mesh) : inside(mesh.cells, mesh.moments) {
  for (int d = 0; d < mesh.directions; ++d) along[at(d)] = block_matrix(mesh.cells, mesh.moments);
}

namespace {

/// Returns J with rows and columns for the sums of the given moments.
row_matrix with_sums(const moment_mesh& mesh, const moment_equations& equations,
                     const std::vector<int>& conserved) {
  const int moments = mesh.moments, unknowns = mesh.unknowns(), sums = static_cast<int>(conserved.size());
  block_matrix all(mesh.cells, moments);
  std::size_t most = equations.inside.blocks();
  for (const block_matrix& some : equations.along) most += some.blocks();
  all.reserve(most);
  const auto add = [&](const block_matrix& some) {
    for (int row = 0; row < some.rows(); ++row)
      some.visit_row(row, [&](int column, const double* block) {
        double* to = all.block(row, column);
        for (int k = 0; k < moments * moments; ++k) to[k] += block[k];
      });
  };
  for (const block_matrix& some : equations.along) add(some);
  add(equations.inside);
  row_matrix matrix(unknowns + sums, unknowns + sums);
  const auto of_blocks = static_cast<Eigen::Index>(all.blocks()) * moments * moments;
  matrix.reserve(of_blocks + 2 * static_cast<Eigen::Index>(mesh.cells) * sums);
  for (int row = 0; row < unknowns; ++row) {
    matrix.startVec(row);
    all.visit_row(row / moments, [&](int column, const double* block) {
      for (int j = 0; j < moments; ++j)
        matrix.insertBackByOuterInnerUnordered(row, column * moments + j) =
            block[row % moments * moments + j];
    });
    for (int k = 0; k < sums; ++k)
      if (row % moments == conserved[at(k)]) matrix.insertBackByOuterInnerUnordered(row, unknowns + k) = 1.0;
  }
  for (int k = 0; k < sums; ++k) {
    matrix.startVec(unknowns + k);
    for (int cell = 0; cell < mesh.cells; ++cell)
      matrix.insertBackByOuterInnerUnordered(unknowns + k, cell * moments + conserved[at(k)]) =
          mesh.volume(cell) / mesh.cells;
  }
  matrix.finalize();
  return matrix;
}

}  // namespace

row_matrix bare_matrix(const moment_mesh& mesh, const moment_equations& equations) {
  return with_sums(mesh, equations, {});
}

row_matrix bordered_matrix(const moment_mesh& mesh, const moment_equations& equations) {
  return with_sums(mesh, equations, equations.conserved);
}

}  // namespace apsis
