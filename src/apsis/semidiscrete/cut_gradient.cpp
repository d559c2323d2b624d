#include <apsis/semidiscrete/cut_gradient.hpp>

#include <apsis/core/index.hpp>

#include <map>

#include <Eigen/Eigenvalues>

namespace apsis {
namespace {

/// Directions have no slope if the eigenvalue of the spread of the neighbours is below this fraction of
/// the largest one.
constexpr double least_spread = 1e-3;

/// Returns the pseudoinverse of the symmetric matrix of a least-squares problem.
Eigen::Matrix3d pseudo_inverse(const Eigen::Matrix3d& m) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> of(m);
  Eigen::Matrix3d inverse = Eigen::Matrix3d::Zero();
  for (int k = 0; k < 3; ++k)
    if (of.eigenvalues()[k] > least_spread * of.eigenvalues()[2])
      inverse += of.eigenvectors().col(k) * of.eigenvectors().col(k).transpose() / of.eigenvalues()[k];
  return inverse;
}

}  // namespace

std::vector<gradient_weight> gradient_weights(const cut_cells& cut, int group) {
  std::map<int, Eigen::Vector3d> around;  // vectors to neighbours, by their first cells
  for (const int f : cut.groups()[at(group)].faces) {
    const open_face& one = cut.faces()[at(f)];
    const bool is_below = one.below >= 0 && cut.group_of(one.below) == group;
    const int other = is_below ? one.above : one.below;
    if (other < 0) continue;
    const int group_of = cut.group_of(other);
    Eigen::Vector3d apart;
    for (int k = 0; k < 3; ++k)
      apart[k] = (is_below ? 1.0 : -1.0) * (one.from_below[at(k)] - one.from_above[at(k)]);
    around.emplace(group_of < 0 ? other : cut.groups()[at(group_of)].cells.front(), apart);
  }
  if (around.empty()) return {};
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  for (const auto& [cell, apart] : around) squares += apart * apart.transpose() / apart.squaredNorm();
  const Eigen::Matrix3d inverse = pseudo_inverse(squares);
  std::vector<gradient_weight> found;
  for (const auto& [cell, apart] : around) {
    const Eigen::Vector3d weight = inverse * apart / apart.squaredNorm();
    found.push_back({cell, {weight[0], weight[1], weight[2]}});
  }
  return found;
}

}  // namespace apsis
