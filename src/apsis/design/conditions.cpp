#include <apsis/design/conditions.hpp>

#include <apsis/method/trees.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace apsis {
namespace {

bool is_leaf(const rooted_tree& tree, colour root) {
  return tree.children.empty() && tree.root == root;
}

/// Whether some node T has a leaf Q; a leaf T in its place gives the same elementary weight if c = ĉ.
bool repeats_another(std::size_t tree, const std::vector<rooted_tree>& trees) {
  return std::any_of(trees[tree].children.begin(), trees[tree].children.end(), [&](int child) {
    const auto c = static_cast<std::size_t>(child);
    return (trees[tree].root == colour::F && is_leaf(trees[c], colour::G)) || repeats_another(c, trees);
  });
}

int index_of(const std::vector<rooted_tree>& trees, const std::string& name) {
  const auto found =
      std::find_if(trees.begin(), trees.end(), [&](const rooted_tree& t) { return t.name == name; });
  return static_cast<int>(found - trees.begin());
}

/// Removes nodes that no condition uses.
condition_list needed(condition_list list) {
  std::vector<char> used(list.nodes.size(), 0);
  for (const auto& c : list.conditions)
    for (const auto& term : c.terms)
      for (const int node : term.nodes) used[static_cast<std::size_t>(node)] = 1;
  const auto mark = [&used](const std::vector<int>& nodes) {
    for (const int n : nodes) used[static_cast<std::size_t>(n)] = 1;
  };
  for (std::size_t n = list.nodes.size(); n-- > 0;) {
    if (used[n] == 0) continue;
    mark(list.nodes[n].children);
    for (const auto& factors : list.nodes[n].merged) mark(factors);
  }
  condition_list kept;
  std::vector<int> place(list.nodes.size(), -1);
  const auto move = [&place](std::vector<int>& nodes) {
    for (int& n : nodes) n = place[static_cast<std::size_t>(n)];
  };
  for (std::size_t n = 0; n < list.nodes.size(); ++n) {
    if (used[n] == 0) continue;
    place[n] = static_cast<int>(kept.nodes.size());
    move(list.nodes[n].children);
    for (auto& factors : list.nodes[n].merged) move(factors);
    kept.nodes.push_back(list.nodes[n]);
  }
  kept.conditions = list.conditions;
  for (auto& c : kept.conditions)
    for (auto& term : c.terms) move(term.nodes);
  return kept;
}

design_condition tree_condition(const std::vector<rooted_tree>& trees, std::size_t k, std::size_t stages) {
  return {trees[k].name, {{1.0, {static_cast<int>(k)}, stages - 1}}, 1.0, trees[k].density};
}

/// Adds a response of the stages at ζ. Returns the index of its real part; the imaginary part is the next
/// node.
int add_response(condition_list& list, series_node::kind what, std::complex<double> zeta) {
  const double previous = what == series_node::kind::response ? 1.0 : 0.0;
  list.nodes.push_back({what, {}, {}, zeta, previous});
  list.nodes.push_back({series_node::kind::imaginary, {}, {}});
  return static_cast<int>(list.nodes.size()) - 2;
}

int add_transport(condition_list& list, int child, double previous = 0.0) {
  list.nodes.push_back({series_node::kind::transport, {child}, {}, 0.0, previous});
  return static_cast<int>(list.nodes.size()) - 1;
}

/// Number of z per decade in band_terms() and layer_terms().
constexpr int band_points = 8;

/// Returns logarithmically spaced radii from 0.1 to 300.
std::vector<double> radii(int to_a_decade) {
  std::vector<double> all;
  for (int k = -to_a_decade; k <= 2.5 * to_a_decade; ++k)
    all.push_back(std::pow(10.0, static_cast<double>(k) / to_a_decade));
  return all;
}

}  // namespace

condition_list order_equations(method_kind kind, int order, std::size_t stages,
                               const std::vector<char>& transport, const std::vector<char>& relaxation,
                               int steps) {
  // Trees of order 2 are needed for the stage equations.
  const auto trees = rooted_trees(std::max(order, 2), colours_of(kind));
  condition_list list{series_of(trees), {}};
  const bool equal_abscissae = kind == method_kind::imex && order >= 3;
  for (std::size_t k = 0; k < trees.size() && trees[k].order <= order; ++k)
    if (!equal_abscissae || !repeats_another(k, trees))
      list.conditions.push_back(tree_condition(trees, k, stages));
  for (std::size_t i = static_cast<std::size_t>(steps) - 1; i + 1 < stages && equal_abscissae; ++i)
    if (transport[i] != 0)
      list.conditions.push_back({fmt::format("c = c_hat at stage {}", i + 1),
                                 {{1.0, {index_of(trees, "G")}, i}, {-1.0, {index_of(trees, "F")}, i}},
                                 0.0});
  for (std::size_t i = 0; i < stages && kind == method_kind::implicit_only && order >= 5; ++i)
    if (relaxation[i] != 0) {
      const int c = index_of(trees, "G");
      list.conditions.push_back({fmt::format("order 2 of stage {}", i + 1),
                                 {{1.0, {index_of(trees, "G[G]")}, i}, {-0.5, {c, c}, i}},
                                 0.0});
    }
  return needed(std::move(list));
}

void add_regime_equations(condition_list& list, regime_demand demand, std::size_t stages) {
  if (demand == regime_demand::none) return;
  const auto add_node = [&list](series_node::kind what) {
    list.nodes.push_back({what, {}, {}});
    return static_cast<int>(list.nodes.size()) - 1;
  };
  const int kept = add_node(series_node::kind::kept);
  list.nodes.back().previous = 1.0;
  list.conditions.push_back({"last = 1", {{1.0, {kept}, stages - 1}}, 1.0});
  list.conditions.push_back({"flux = 1", {{1.0, {add_transport(list, kept, -1.0)}, stages - 1}}, 1.0});
  if (demand != regime_demand::all) return;
  const int layer = add_node(series_node::kind::layer);
  list.conditions.push_back({"layer = 1", {{1.0, {add_transport(list, layer)}, stages - 1}}, 1.0});
}

condition_list band_terms(std::size_t stages, int steps) {
  const std::size_t last = stages - 1;
  condition_list list;
  // For two-step methods flux is divided by Σ b̂ = 1 + (weight of u^{n−1} in the result).
  const int of_one =
      steps == 2 ? add_transport(list, add_response(list, series_node::kind::response, 0.0)) : -1;
  for (const double z : radii(band_points)) {
    const int moved = add_response(list, series_node::kind::moved, -z);
    const int start = add_response(list, series_node::kind::response, -z);
    const int of_moved = add_transport(list, moved), of_start = add_transport(list, start);
    // κ = moved + κ_s start, κ_s = moved_s/(1 − start_s); (flux(z) − 1)(1 − start_s) is a polynomial in
    // the stage values.
    const double w = std::sqrt(1.0 / band_points) / (z * -std::expm1(-z));
    if (steps == 2) {
      list.conditions.push_back({fmt::format("flux at z = {:.3g}", z),
                                 {{w, {of_moved}, last},
                                  {-w, {of_moved, start}, last},
                                  {w, {moved, of_start}, last},
                                  {w, {of_one, start}, last},
                                  {-w, {of_one}, last}},
                                 0.0});
      continue;
    }
    list.conditions.push_back({fmt::format("flux at z = {:.3g}", z),
                               {{w, {of_moved}, last},
                                {-w, {of_moved, start}, last},
                                {w, {moved, of_start}, last},
                                {w, {start}, last}},
                               w});
  }
  return list;
}

condition_list layer_terms(std::size_t stages, int steps) {
  const std::size_t last = stages - 1;
  const double w = std::sqrt(1.0 / band_points);
  condition_list list;
  for (const double z : radii(band_points)) {
    const int start = add_response(list, series_node::kind::response, -z);
    if (steps == 1) {
      const int of_start = add_transport(list, start);
      list.conditions.push_back(
          {fmt::format("layer at z = {:.3g}", z), {{w, {of_start}, last}, {w / z, {start}, last}}, w / z});
    }
    // (last(z) − 1)(1 − start_s) = moved_s + start_s − 1.
    const int moved = add_response(list, series_node::kind::moved, -z);
    const double v = w / (z * -std::expm1(-z));
    list.conditions.push_back(
        {fmt::format("deviation at z = {:.3g}", z), {{v, {moved}, last}, {v, {start}, last}}, v});
  }
  return list;
}

condition_list stability_limits(double degrees, std::size_t stages) {
  constexpr int to_a_decade = 24;
  const double angle = degrees * std::numbers::pi / 180.0;
  condition_list list;
  for (const double radius : radii(to_a_decade)) {
    const int re = add_response(list, series_node::kind::response, -std::polar(radius, -angle));
    // For orders 2 and 3, |R|² − 1 is O(|ζ|⁴) on the imaginary axis.
    const double w = std::pow(std::min(1.0, radius), -4.0);
    list.conditions.push_back({fmt::format("|R| at |z| = {:.3g}", radius),
                               {{w, {re, re}, stages - 1}, {w, {re + 1, re + 1}, stages - 1}},
                               w});
  }
  return list;
}

condition_list error_terms(method_kind kind, int order, std::size_t stages) {
  const auto trees = rooted_trees(order, colours_of(kind));
  condition_list list{series_of(trees), {}};
  for (std::size_t k = 0; k < trees.size(); ++k)
    if (trees[k].order == order) list.conditions.push_back(tree_condition(trees, k, stages));
  return needed(std::move(list));
}

}  // namespace apsis
