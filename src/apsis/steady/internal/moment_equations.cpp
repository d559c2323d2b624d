#include <apsis/steady/internal/moment_equations.hpp>

#include <apsis/core/index.hpp>

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
  for (const int cell : links.cells())  // of rings, which have no end
    if (!visited[at(cell)]) follow(cell);
  return found;
}

Eigen::SparseMatrix<double> bordered_matrix(const moment_mesh& mesh, const moment_equations& equations) {
  moment_equations::terms all = equations.inside;
  for (const auto& terms : equations.along) all.insert(all.end(), terms.begin(), terms.end());
  int extra = mesh.unknowns();
  for (const int moment : equations.conserved) {
    for (int cell = 0; cell < mesh.cells; ++cell) {
      all.emplace_back(cell * mesh.moments + moment, extra, 1.0);
      all.emplace_back(extra, cell * mesh.moments + moment, 1.0 / mesh.cells);
    }
    ++extra;
  }
  Eigen::SparseMatrix<double> matrix(extra, extra);
  matrix.setFromTriplets(all.begin(), all.end());
  matrix.makeCompressed();
  return matrix;
}

}  // namespace apsis
