#include <apsis/design/draw.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace apsis {
namespace {

using form_type = shu_osher_form<double>;

/// Draws a random subset of m out of n elements.
std::vector<char> draw_subset(random_source& random, std::size_t n, std::size_t m) {
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), 0);
  std::vector<char> chosen(n, 0);
  for (std::size_t k = 0; k < std::min(m, n); ++k) {
    std::swap(order[k],
              order[static_cast<std::size_t>(random.integer(static_cast<int>(k), static_cast<int>(n)))]);
    chosen[order[k]] = 1;
  }
  return chosen;
}

/// Returns which stages of a given method evaluate T.
std::vector<char> transport_of(const form_type& m) {
  std::vector<char> used(m.stages(), 0);
  for (std::size_t i = 0; i < m.stages(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (m.W(i, j) != 0.0) used[j] = 1;
  return used;
}

bool is_fifth_order_implicit(const design_task& task) {
  return task.kind == method_kind::implicit_only && task.demands.order >= 5;
}

bool is_fourth_order_imex(const design_task& task) {
  return task.kind == method_kind::imex && task.demands.order >= 4;
}

/// Draws the stages that evaluate T. An explicit SSP method of order 4 needs five evaluations, and all known
/// methods of order 4 evaluate T at the first stage.
std::vector<char> draw_transport(const design_task& task, random_source& random) {
  const std::size_t s = task.stages;
  std::vector<char> transport(s, 0);
  if (task.kind == method_kind::implicit_only) return transport;
  const int most = static_cast<int>(s) - 1;
  const bool fourth = is_fourth_order_imex(task);
  int evaluations = 0;
  if (task.transports) {
    evaluations = *task.transports;
  } else {
    evaluations = fourth ? std::min(most, random.integer(5, 7)) : random.integer(1, most + 1);
  }
  const std::size_t first = fourth ? 1 : 0;
  const auto chosen = draw_subset(random, s - 1 - first, static_cast<std::size_t>(evaluations) - first);
  std::copy(chosen.begin(), chosen.end(), transport.begin() + static_cast<std::ptrdiff_t>(first));
  if (fourth) transport[0] = 1;
  return transport;
}

/// Draws sparse rows, like those of good methods; `chained` rows use only the previous stage.
void draw_weights(form_type& m, const zero_pattern& pattern, bool chained, random_source& random) {
  const auto weight = [&random] { return random.one_in(2) ? 0.0 : -std::log(1.0 - random.uniform()); };
  for (std::size_t i = 1; i < pattern.stages(); ++i) {
    if (chained && !random.one_in(3)) {
      m.P(i, i - 1) = 1.0;
      continue;
    }
    double sum = pattern.initial[i] != 0 ? weight() : 0.0;
    for (std::size_t j = 0; j < i; ++j) {
      if (pattern.P(i, j) != 0) sum += m.P(i, j) = weight();
      if (pattern.W(i, j) != 0) sum += m.W(i, j) = weight();
    }
    for (std::size_t j = 0; j < i && sum > 0.0; ++j) {
      m.P(i, j) /= sum;
      m.W(i, j) /= sum;
    }
  }
}

/// Draws two to four stages without T that lie far ahead in time. They are mostly chained and have small
/// weights in other stages. With c up to five they raise the high moments but hardly the low ones. From other
/// initial points a search for order 4 ends with r at its lower bound, small d and residuals of 10⁻³.
void draw_far_stages(form_type& m, const zero_pattern& pattern, double box, random_source& random) {
  const std::size_t s = pattern.stages();
  const auto transport = pattern.transport();
  const auto most = static_cast<std::size_t>(random.integer(2, 5));
  std::vector<std::size_t> far;
  std::vector<char> is_far(s, 0);
  for (std::size_t i = 1; i + 1 < s && far.size() < most; ++i)
    if (transport[i] == 0 && random.one_in(2)) {
      far.push_back(i);
      is_far[i] = 1;
    }
  const double chained = random.uniform(0.3, 1.0);
  for (std::size_t i = 0; i < s; ++i) {
    const bool ahead = is_far[i] != 0;
    const bool without_d = random.one_in(ahead ? 4 : 3);
    const double d = ahead ? box * random.uniform(0.3, 1.0) : random.uniform(0.0, 0.6);
    const double ddot = ahead ? box * random.uniform(0.3, 1.0) : 0.3 * random.uniform() * random.uniform();
    m.D(i, i) = without_d ? 0.0 : d;
    m.ddot[i] = -ddot;
  }
  for (std::size_t k = 0; k < far.size(); ++k) {
    const std::size_t stage = far[k];
    if (k > 0 && random.uniform() < chained) {
      for (std::size_t j = 0; j < stage; ++j) {
        m.P(stage, j) *= 0.01;
        m.W(stage, j) *= 0.01;
      }
      m.P(stage, far[k - 1]) = 0.98;
    }
    const double taken = random.magnitude(-3.5, -1.0);
    for (std::size_t i = stage + 1; i < s; ++i)
      if (is_far[i] == 0) m.P(i, stage) *= taken;
  }
}

/// Returns the pattern with T evaluated at `more` additional random stages.
zero_pattern with_more_transport(zero_pattern pattern, std::vector<char> transport, std::size_t more,
                                 random_source& random) {
  std::vector<std::size_t> without;
  for (std::size_t i = 0; i + 1 < transport.size(); ++i)
    if (transport[i] == 0) without.push_back(i);
  const auto chosen = draw_subset(random, without.size(), more);
  for (std::size_t k = 0; k < without.size(); ++k)
    if (chosen[k] != 0) transport[without[k]] = 1;
  pattern.W = full_pattern(pattern.kind, transport, pattern.steps).W;
  return pattern;
}

}  // namespace

zero_pattern pattern_near(const design_task& task, const form_type& m) {
  auto pattern = full_pattern(task.kind, transport_of(m), task.steps);
  const bool stages_differ = task.demands.regime != regime_demand::none || is_fifth_order_implicit(task);
  for (std::size_t i = 0; i < m.stages() && stages_differ; ++i) {
    pattern.d[i] = static_cast<char>(m.D(i, i) != 0.0);
    pattern.ddot[i] = static_cast<char>(m.ddot[i] != 0.0);
  }
  return pattern;
}

zero_pattern draw_pattern(const design_task& task, random_source& random) {
  if (task.from) {
    auto transport = transport_of(*task.from);
    auto pattern = pattern_near(task, *task.from);
    const auto more = task.transports.value_or(0) - std::count(transport.begin(), transport.end(), 1);
    if (more <= 0) return pattern;
    return with_more_transport(pattern, std::move(transport), static_cast<std::size_t>(more), random);
  }
  auto pattern = full_pattern(task.kind, draw_transport(task, random), task.steps);
  const std::size_t s = task.stages;
  if (task.kind == method_kind::imex && task.demands.regime != regime_demand::none)
    for (std::size_t i = 0; i < s; ++i)
      if (i + 1 == s || random.one_in(2)) pattern.ddot[i] = 0;
  // In all known methods of order 5, a third of the stages has d = 0, neither the first nor the last.
  if (is_fifth_order_implicit(task) && s > 2) {
    const auto without_d = draw_subset(random, s - 2, s / 3);
    for (std::size_t i = 1; i + 1 < s; ++i) pattern.d[i] = static_cast<char>(without_d[i - 1] == 0);
  }
  return pattern;
}

Eigen::VectorXd draw_coefficients(const design_task& task, const design_problem& problem,
                                  random_source& random, bool is_first) {
  if (task.from) {
    Eigen::VectorXd x = problem.unknowns_of(*task.from);
    const double away = is_first ? 0.0 : random.magnitude(-4.0, -1.0);
    for (double& value : x) value += away * random.uniform(-1.0, 1.0);
    return x.cwiseMax(problem.lower()).cwiseMin(problem.upper());
  }
  const auto& pattern = problem.pattern();
  const std::size_t s = pattern.stages();
  const bool fifth = is_fifth_order_implicit(task), fourth = is_fourth_order_imex(task);
  form_type m;
  m.P = m.W = m.D = matrix<double>(s, s);
  m.ddot.assign(s, 0.0);
  draw_weights(m, pattern, fifth, random);
  // Magnitudes up to the box; stages of order 2 have |ḋ| of about d²/2.
  const double size =
      fifth ? random.uniform(0.2, 1.0) : random.uniform(0.3, 1.0) * std::min(task.demands.box, 4.0);
  for (std::size_t i = 0; i < s; ++i) {
    m.D(i, i) = size * std::pow(random.uniform(), fifth ? 1.0 : 2.0);
    m.ddot[i] = -(fifth ? 0.5 : 1.0) * size * std::pow(random.uniform(), 2.0);
  }
  if (fourth) draw_far_stages(m, pattern, std::min(task.demands.box, 4.0), random);
  for (std::size_t i = 0; i < s; ++i) {
    if (pattern.d[i] == 0) m.D(i, i) = 0.0;
    if (pattern.ddot[i] == 0) m.ddot[i] = 0.0;
  }
  const auto transport = pattern.transport();
  const auto evaluations = static_cast<double>(std::count(transport.begin(), transport.end(), 1));
  m.r = random.uniform(0.1, 0.8) * (fourth ? 2.0 : std::max(1.0, evaluations));
  return problem.unknowns_of(m).cwiseMax(problem.lower()).cwiseMin(problem.upper());
}

}  // namespace apsis
