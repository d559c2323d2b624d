#include <apsis/design/embedded.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/design/nonnegative_least_squares.hpp>
#include <apsis/design/stage_series.hpp>
#include <apsis/method/precision.hpp>

#include <algorithm>
#include <cmath>

#include <boost/multiprecision/eigen.hpp>
#include <fmt/format.h>

namespace apsis {
namespace {

using mp_vector = Eigen::Vector<mp_real, Eigen::Dynamic>;
using mp_matrix = Eigen::Matrix<mp_real, Eigen::Dynamic, Eigen::Dynamic>;

constexpr int digits = 45;

/// Trees of T alone, of Q alone, and all others.
enum class tree_part { transport, relaxation, mixed };

tree_part part_of(const std::vector<rooted_tree>& trees, const rooted_tree& tree) {
  const tree_part own = tree.root == colour::F ? tree_part::transport : tree_part::relaxation;
  const bool pure = std::all_of(tree.children.begin(), tree.children.end(), [&](int child) {
    return part_of(trees, trees[static_cast<std::size_t>(child)]) == own;
  });
  return pure ? own : tree_part::mixed;
}

/// The linear conditions on an embedded row: A x = b for trees up to order q and for the sum of the weights,
/// and E x for those of order q + 1, with t = 1/γ. Rows of E and t are divided by the ‖t‖ of their part.
class embedded_program {
 public:
  embedded_program(const method& m, int order, embedded_cost cost)
      : form_(m.coefficients<mp_real>()), trees_(rooted_trees(order + 1, colours_of(m.kind))) {
    const bool keeps = m.claims.intermediate.has_value() && cost == embedded_cost::one_solve;
    choose_unknowns(m.kind, cost, keeps);
    stage_series<mp_real> series(series_of(trees_), std::vector<char>(m.stages(), 0));
    series.evaluate(form_);
    std::vector<std::size_t> equations, next;
    for (std::size_t k = 0; k < trees_.size(); ++k)
      (trees_[k].order <= order ? equations : next).push_back(k);
    const auto conditions = static_cast<Eigen::Index>(equations.size());
    A = mp_matrix::Zero(conditions + (keeps ? 2 : 1), size());
    b = mp_vector::Zero(A.rows());
    fill(series, equations, A, b);
    b(conditions) = 1;
    for (Eigen::Index u = 0; u < size(); ++u) {
      const part what = unknowns_[static_cast<std::size_t>(u)].what;
      A(conditions, u) = mp_real(what != part::d && what != part::ddot ? 1 : 0);  // the sum of the weights
      if (keeps && what == part::W) A(conditions + 1, u) = 1 / form_.r;
      if (keeps && what == part::d) A(conditions + 1, u) = -1;
    }
    E = mp_matrix::Zero(static_cast<Eigen::Index>(next.size()), size());
    t = mp_vector::Zero(E.rows());
    fill(series, next, E, t);
    for (const std::size_t k : next) parts.push_back(part_of(trees_, trees_[k]));
    for (const auto group : {tree_part::transport, tree_part::relaxation, tree_part::mixed}) {
      const auto rows = rows_of(group);
      if (rows.empty()) continue;
      const mp_real length = t(rows).norm();
      E(rows, Eigen::all) /= length;
      t(rows) /= length;
    }
  }

  mp_matrix A, E;
  mp_vector b, t;
  std::vector<tree_part> parts;  ///< part of each row of E

  std::vector<Eigen::Index> rows_of(tree_part group) const {
    std::vector<Eigen::Index> rows;
    for (std::size_t k = 0; k < parts.size(); ++k)
      if (parts[k] == group) rows.push_back(static_cast<Eigen::Index>(k));
    return rows;
  }

  Eigen::Index size() const { return static_cast<Eigen::Index>(unknowns_.size()); }
  /// Returns the indices of d̃ and −d̃̇ in x, if they are unknowns.
  const std::vector<Eigen::Index>& implicit_places() const { return implicit_; }

  embedded_row row(const mp_vector& x, int order, std::string (*text)(const mp_real&)) const {
    embedded_row out;
    out.order = order;
    out.convex = x.minCoeff() >= 0;
    out.P.assign(form_.stages(), "0");
    out.W = out.P;
    for (std::size_t u = 0; u < unknowns_.size(); ++u) {
      const mp_real& value = x(static_cast<Eigen::Index>(u));
      const auto& [what, stage] = unknowns_[u];
      if (what == part::P) out.P[stage] = text(value);
      if (what == part::W) out.W[stage] = text(value);
      if (what == part::d) out.d = text(value);
      if (what == part::ddot) out.ddot = text(-value);
    }
    return out;
  }

 private:
  enum class part { P, W, initial, d, ddot };
  struct unknown {
    part what;
    std::size_t stage;
  };

  void choose_unknowns(method_kind kind, embedded_cost cost, bool keeps) {
    const std::size_t last = form_.stages() - 1;  // u^{n+1}, which has weight 0
    for (std::size_t j = 0; j < last; ++j) unknowns_.push_back({part::P, j});
    const bool solved = cost == embedded_cost::one_solve;
    for (std::size_t j = 0; j < last && (solved || kind == method_kind::explicit_only); ++j) {
      bool evaluated = false;
      for (std::size_t i = 0; i <= last; ++i) evaluated = evaluated || form_.W(i, j) != 0;
      if (evaluated) unknowns_.push_back({part::W, j});
    }
    unknowns_.push_back({part::initial, 0});
    if (!solved) return;
    for (const part what : {part::d, part::ddot}) {
      if (keeps && what == part::ddot) continue;  // Q̇ would drop the O(ε) term
      implicit_.push_back(size());
      unknowns_.push_back({what, 0});
    }
  }

  /// at_stage() returns the product of the stage vectors of `factors` at a stage, at_end() that of their 1/γ.
  static mp_real at_stage(const stage_series<mp_real>& series, const std::vector<int>& factors,
                          std::size_t stage) {
    mp_real product(1);
    for (const int f : factors) product *= series.value(f, stage);
    return product;
  }
  mp_real at_end(const std::vector<int>& factors) const {
    mp_real product(1);
    for (const int f : factors) product /= mp_real(trees_[static_cast<std::size_t>(f)].density);
    return product;
  }

  void fill(const stage_series<mp_real>& series, const std::vector<std::size_t>& which, mp_matrix& rows,
            mp_vector& right) const {
    const auto nodes = series_of(trees_);
    for (std::size_t e = 0; e < which.size(); ++e) {
      const std::size_t k = which[e];
      const auto& node = nodes[k];
      const bool relaxes = node.what == series_node::kind::relaxation;
      const auto row = static_cast<Eigen::Index>(e);
      right(row) = mp_real(1) / mp_real(trees_[k].density);
      for (std::size_t u = 0; u < unknowns_.size(); ++u) {
        const auto& [what, j] = unknowns_[u];
        mp_real& entry = rows(row, static_cast<Eigen::Index>(u));
        if (what == part::P || what == part::W) entry = series.value(static_cast<int>(k), j);
        if (what == part::W && !relaxes) entry += at_stage(series, node.children, j) / form_.r;
        if (what == part::d && relaxes) entry = at_end(node.children);
        if (what == part::ddot && relaxes)
          for (const auto& factors : node.merged) entry -= at_end(factors);
      }
    }
  }

  shu_osher_form<mp_real> form_;
  std::vector<rooted_tree> trees_;
  std::vector<unknown> unknowns_;
  std::vector<Eigen::Index> implicit_;
};

/// Stacks weight · A x on top of E x: in 60 digits least squares then satisfy A x = b to weight⁻².
std::pair<mp_matrix, mp_vector> weighted(const embedded_program& program, const mp_vector& b,
                                         const mp_vector& goal, const mp_real& weight) {
  mp_matrix rows(program.A.rows() + program.E.rows(), program.size());
  mp_vector right(rows.rows());
  rows << weight * program.A, program.E;
  right << weight * b, goal;
  return {rows, right};
}

/// Returns arg min ‖E x − goal‖² over A x = b, x ≥ least. The active set is found with a weight for which
/// rounding errors of the 45 digits of the method stay below the gradients. With a larger weight the free
/// unknowns then satisfy the equations to all digits.
mp_vector closest_solution(const embedded_program& program, const mp_vector& goal, const mp_vector& least) {
  const mp_vector b = program.b - program.A * least, rest = goal - program.E * least;
  const auto [rows, right] = weighted(program, b, rest, mp_real(1e10));
  mp_vector x = nonnegative_least_squares<mp_real>(rows, right, mp_real(1e-12));
  std::vector<Eigen::Index> positive;
  for (Eigen::Index k = 0; k < x.size(); ++k)
    if (x(k) > 0) positive.push_back(k);
  const auto [exact_rows, exact_right] = weighted(program, b, rest, mp_real(1e25));
  const mp_vector polished = exact_rows(Eigen::all, positive).colPivHouseholderQr().solve(exact_right);
  if (polished.size() > 0 && polished.minCoeff() > 0) x(positive) = polished;
  return x + least;
}

/// Formats a rational of small denominator exactly, any other number as a decimal.
std::string text_of(const mp_real& value) {
  if (abs(value) < mp_real(1e-40)) return "0";
  for (int q = 1; q <= 1000; ++q) {
    const mp_real p = round(value * q);
    if (abs(value - p / q) > mp_real(1e-32)) continue;
    const long numerator = p.convert_to<long>();
    return q == 1 ? fmt::format("{}", numerator) : fmt::format("{}/{}", numerator, q);
  }
  return value.str(digits, std::ios_base::fixed);
}

struct candidate {
  mp_vector x;
  mp_real residual, distance, coverage;
};

std::optional<candidate> better(const std::optional<candidate>& a, const candidate& b) {
  return a && a->distance <= b.distance ? a : std::optional(b);
}

/// Returns the solution with weights above `least_weight` for the better sign of θ = ±1/parts. If d̃ − d̃̇ would
/// be below the margin, d̃ or −d̃̇ is constrained to be at least the margin.
candidate best_of(const embedded_program& program, int parts, const mp_real& least_weight,
                  const mp_real& margin) {
  const auto& implicit = program.implicit_places();
  const auto solve = [&](const mp_real& theta, const mp_vector& least) {
    const mp_vector goal = (1 - theta) * program.t;
    candidate c{closest_solution(program, goal, least), 0, 0, 0};
    c.residual = (program.A * c.x - program.b).cwiseAbs().maxCoeff();
    c.distance = (program.E * c.x - goal).norm();
    c.coverage = 1 / abs(theta);
    const mp_vector estimate = program.t - program.E * c.x;
    for (const auto group : {tree_part::transport, tree_part::relaxation})
      if (const auto rows = program.rows_of(group); !rows.empty())
        c.coverage = std::min(c.coverage, mp_real(estimate(rows).norm() / abs(theta)));
    return c;
  };
  std::optional<candidate> best;
  for (const mp_real& theta : {mp_real(1) / parts, mp_real(-1) / parts}) {
    mp_vector lowest = mp_vector::Constant(program.size(), least_weight);
    lowest(implicit).setZero();
    const auto free = solve(theta, lowest);
    if (implicit.empty() || free.x(implicit).sum() >= margin) {
      best = better(best, free);
      continue;
    }
    for (const Eigen::Index place : implicit) {
      mp_vector least = lowest;
      least(place) = margin;
      best = better(best, solve(theta, least));
    }
  }
  return *best;
}

void require_class(const method& m, const embedded_task& task) {
  const auto refuse = [&m](const std::string& why, const std::string& suggestion) {
    throw input_error(
        fmt::format("method '{}' cannot have such an embedded solution ({}); {}", m.name, why, suggestion));
  };
  if (m.is_tableau()) refuse("Q of a stage enters a later one", "choose a method of the paper's class");
  if (m.ends_with_update()) refuse("u^{n+1} is not a stage", "choose a method of the paper's class");
  if (m.kind == method_kind::explicit_only && task.cost == embedded_cost::one_solve)
    refuse("it is explicit and has no stage solves", "ask for the cost \"nothing\"");
  if (m.claims.order < 2) refuse("its order is 1", "choose a method of order 2 or more");
  if (task.order < 0 || task.order >= m.claims.order)
    refuse(fmt::format("order {} is not below the order {} of the method", task.order, m.claims.order),
           "ask for a lower one");
}

}  // namespace

embedded_search search_embedded(const method& m, const embedded_task& task) {
  require_class(m, task);
  embedded_search search;
  const int highest = task.order > 0 ? task.order : m.claims.order - 1,
            lowest = task.order > 0 ? task.order : 1;
  for (int q = highest; q >= lowest && !search.found; --q) {
    const embedded_program program(m, q, task.cost);
    const int parts = task.parts > 0 ? task.parts : default_parts(q);
    for (const bool convex : {true, false}) {
      if (search.found || (!convex && (q == 1 || m.kind != method_kind::imex))) continue;
      const mp_real least = convex ? mp_real(0) : -round(mp_real(1000) * task.negative) / (1000 * parts);
      const candidate best = best_of(program, parts, least, task.margin);
      search.attempts.push_back(
          {q, convex, best.residual.convert_to<double>(), best.coverage.convert_to<double>()});
      const bool solves = best.residual < pow(mp_real(10), 3 - digits);
      if (solves && best.coverage >= task.least_coverage) search.found = program.row(best.x, q, text_of);
    }
  }
  return search;
}

}  // namespace apsis
