#include <apsis/design/design_problem.hpp>

#include <apsis/method/precision.hpp>

#include <algorithm>

#include <fmt/format.h>

namespace apsis {
namespace {

condition_list equations_of(const zero_pattern& pattern, const design_demands& demands) {
  auto list = order_equations(pattern.kind, demands.order, pattern.stages(), pattern.transport(), pattern.d,
                              pattern.steps);
  if (pattern.kind == method_kind::imex) add_regime_equations(list, demands.regime, pattern.stages());
  return list;
}

/// Returns which stages relax without Q̇ by design.
std::vector<char> slow_stages(const zero_pattern& pattern) {
  std::vector<char> slow(pattern.stages(), 0);
  for (std::size_t i = 0; i < slow.size(); ++i)
    slow[i] = static_cast<char>(pattern.d[i] != 0 && pattern.ddot[i] == 0);
  return slow;
}

}  // namespace

double design_demands::aimed_angle() const {
  return least_angle + 0.05 * (90.0 - least_angle);
}

double design_demands::largest_ddot(bool with_d) const {
  const double square = least_pole * least_pole;
  return !with_d && square * box > 1.0 ? 1.0 / square : box;
}

std::vector<char> zero_pattern::transport() const {
  std::vector<char> used(stages(), 0);
  for (std::size_t i = 0; i < stages(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (W(i, j) != 0) used[j] = 1;
  return used;
}

zero_pattern full_pattern(method_kind kind, const std::vector<char>& transport, int steps) {
  const std::size_t s = transport.size();
  zero_pattern p;
  p.kind = kind;
  p.P = p.W = matrix<char>(s, s);
  p.d.assign(s, static_cast<char>(kind != method_kind::explicit_only));
  p.ddot = p.d;
  p.steps = steps;
  if (steps == 2) p.d[0] = p.ddot[0] = 0;
  p.initial.assign(s, 1);
  for (std::size_t i = 0; i < s; ++i)
    for (std::size_t j = 0; j < i; ++j) {
      p.P(i, j) = 1;
      p.W(i, j) = static_cast<char>(transport[j] != 0 && kind != method_kind::implicit_only);
    }
  return p;
}

design_problem::design_problem(zero_pattern pattern, const design_demands& demands)
    : pattern_(std::move(pattern)),
      demands_(demands),
      slow_(slow_stages(pattern_)),
      conditions_(equations_of(pattern_, demands_), slow_, pattern_.steps) {
  if (demands_.least_angle > 0.0 && pattern_.kind != method_kind::explicit_only)
    limits_.emplace(stability_limits(demands_.aimed_angle(), pattern_.stages()), slow_, pattern_.steps);
  for (const auto& c : equations_of(pattern_, demands_).conditions) names_.push_back(c.name);
  const std::size_t s = pattern_.stages();
  std::vector<std::pair<double, double>> bounds;
  const std::size_t given = demands_.given_rows ? demands_.given_rows->stages() : 0;
  const auto given_initial =
      demands_.given_rows ? initial_weights(*demands_.given_rows) : std::vector<double>();
  const auto declare = [&](part what, std::size_t i, std::size_t j, double lower, double upper) {
    unknowns_.push_back({what, i, j});
    if (i < given) {
      const double* value = entry(*demands_.given_rows, unknowns_.back());
      lower = upper = value != nullptr ? *value : std::max(0.0, given_initial[i]);
    }
    bounds.emplace_back(lower, upper);
    return static_cast<Eigen::Index>(unknowns_.size()) - 1;
  };
  for (std::size_t i = 1; i < s; ++i) {
    rows_.emplace_back();
    names_.push_back(fmt::format("weights of stage {}", i + 1));
    for (std::size_t j = 0; j < i; ++j) {
      if (pattern_.P(i, j) != 0) rows_.back().push_back(declare(part::P, i, j, 0.0, 1.0));
      if (pattern_.W(i, j) != 0) rows_.back().push_back(declare(part::W, i, j, 0.0, 1.0));
    }
    if (pattern_.initial[i] != 0) rows_.back().push_back(declare(part::initial, i, 0, 0.0, 1.0));
  }
  const bool relaxes = pattern_.kind != method_kind::explicit_only;
  for (std::size_t i = 0; i < s && relaxes; ++i) {
    const bool both = pattern_.d[i] != 0 && pattern_.ddot[i] != 0;
    Eigen::Index d = -1, ddot = -1;
    if (pattern_.d[i] != 0) d = declare(part::d, i, i, both ? 0.0 : demands_.margin, demands_.box);
    if (pattern_.ddot[i] != 0)
      ddot = declare(part::ddot, i, i, -demands_.largest_ddot(pattern_.d[i] != 0),
                     both ? 0.0 : -demands_.margin);
    if (both && i >= given) inequalities_.push_back({{{d, 1.0}, {ddot, -1.0}}, demands_.margin});
  }
  if (pattern_.kind != method_kind::implicit_only)
    r_place_ = declare(part::r, 0, 0, demands_.least_r, demands_.largest_r);
  lower_.resize(static_cast<Eigen::Index>(bounds.size()));
  upper_.resize(lower_.size());
  for (std::size_t k = 0; k < bounds.size(); ++k) {
    lower_(static_cast<Eigen::Index>(k)) = bounds[k].first;
    upper_(static_cast<Eigen::Index>(k)) = bounds[k].second;
  }
}

template <class Real>
Real* design_problem::entry(shu_osher_form<Real>& m, const unknown& u) {
  switch (u.what) {
    case part::P:
      return &m.P(u.i, u.j);
    case part::W:
      return &m.W(u.i, u.j);
    case part::d:
      return &m.D(u.i, u.i);
    case part::ddot:
      return &m.ddot[u.i];
    case part::r:
      return &m.r;
    case part::initial:
      break;
  }
  return nullptr;  // in a form it is 1 − Σ_j (p_ij + w_ij)
}

template <class Real>
shu_osher_form<Real> design_problem::empty_form() const {
  const std::size_t s = pattern_.stages();
  shu_osher_form<Real> m;
  m.P = m.W = m.D = matrix<Real>(s, s);
  m.ddot.assign(s, Real(0.0));
  m.r = Real(0.0);
  return m;
}

template <class Real>
shu_osher_form<Real> design_problem::form_of(const std::vector<Real>& x) const {
  auto m = empty_form<Real>();
  m.r = Real(1.0);
  for (std::size_t k = 0; k < x.size(); ++k)
    if (Real* to = entry(m, unknowns_[k]); to != nullptr) *to = x[k];
  return m;
}

template shu_osher_form<mp_real> design_problem::form_of(const std::vector<mp_real>&) const;

template <class Real>
condition_sweep<Real> design_problem::sweep() const {
  return condition_sweep<Real>(equations_of(pattern_, demands_), slow_, pattern_.steps);
}

template condition_sweep<mp_real> design_problem::sweep() const;

shu_osher_form<double> design_problem::form(const Eigen::VectorXd& x) const {
  return form_of(std::vector<double>(x.begin(), x.end()));
}

Eigen::VectorXd design_problem::unknowns_of(const shu_osher_form<double>& m) const {
  auto copy = m;
  const auto initial = initial_weights(m);
  Eigen::VectorXd x(unknowns());
  for (std::size_t k = 0; k < unknowns_.size(); ++k) {
    const double* from = entry(copy, unknowns_[k]);
    x(static_cast<Eigen::Index>(k)) = from != nullptr ? *from : initial[unknowns_[k].i];
  }
  return x;
}

namespace {

Eigen::VectorXd values_of(const condition_sweep<double>& sweep, Eigen::Index size) {
  Eigen::VectorXd values(size);
  for (std::size_t k = 0; k < sweep.size(); ++k) values(static_cast<Eigen::Index>(k)) = sweep.residual(k);
  return values;
}

}  // namespace

Eigen::VectorXd design_problem::residuals(const Eigen::VectorXd& x) {
  conditions_.first.evaluate(form(x));
  Eigen::VectorXd c = values_of(conditions_.first, equations());
  auto k = static_cast<Eigen::Index>(conditions_.first.size());
  for (const auto& row : rows_) {
    double sum = -1.0;
    for (const auto place : row) sum += x(place);
    c(k++) = sum;
  }
  return c;
}

Eigen::VectorXd design_problem::gradient_of(condition_sweep<double>& seeded) const {
  auto g = empty_form<double>();
  seeded.reverse(g);
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(unknowns());
  for (std::size_t u = 0; u < unknowns_.size(); ++u)
    if (const double* from = entry(g, unknowns_[u]); from != nullptr)
      gradient(static_cast<Eigen::Index>(u)) = *from;
  return gradient;
}

Eigen::MatrixXd design_problem::gradients_of(condition_sweep<double>& sweep, Eigen::Index rows) const {
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(rows, unknowns());
  for (std::size_t k = 0; k < sweep.size(); ++k) {
    sweep.seed(k, 1.0);
    J.row(static_cast<Eigen::Index>(k)) = gradient_of(sweep);
  }
  return J;
}

Eigen::MatrixXd design_problem::jacobian(const Eigen::VectorXd& x) {
  conditions_.first.evaluate(form(x));
  Eigen::MatrixXd J = gradients_of(conditions_.first, equations());
  auto k = static_cast<Eigen::Index>(conditions_.first.size());
  for (const auto& row : rows_) {
    for (const auto place : row) J(k, place) = 1.0;
    ++k;
  }
  return J;
}

Eigen::VectorXd design_problem::limit_values(const Eigen::VectorXd& x) {
  if (!limits_) return {};
  limits_->first.evaluate(form(x));
  return values_of(limits_->first, limits());
}

Eigen::MatrixXd design_problem::limit_jacobian(const Eigen::VectorXd& x) {
  if (!limits_) return Eigen::MatrixXd(0, unknowns());
  limits_->first.evaluate(form(x));
  return gradients_of(limits_->first, limits());
}

design_problem::sweeps& design_problem::terms_of(measure what) {
  const auto ready = [this](std::optional<sweeps>& terms, const auto& list) -> sweeps& {
    if (!terms) terms.emplace(list(pattern_.stages()), slow_, pattern_.steps);
    return *terms;
  };
  if (what == measure::band)
    return ready(band_, [this](std::size_t s) { return band_terms(s, pattern_.steps); });
  if (what == measure::layer)
    return ready(layer_, [this](std::size_t s) { return layer_terms(s, pattern_.steps); });
  return ready(error_, [this](std::size_t s) { return error_terms(pattern_.kind, demands_.order + 1, s); });
}

double design_problem::half_square(measure what, const Eigen::VectorXd& x, Eigen::VectorXd* gradient) {
  auto& terms = terms_of(what).first;
  terms.evaluate(form(x));
  double sum = 0.0;
  for (std::size_t k = 0; k < terms.size(); ++k) {
    const double residual = terms.residual(k);
    sum += 0.5 * residual * residual;
    if (gradient != nullptr) terms.seed(k, residual);
  }
  if (gradient != nullptr) *gradient = gradient_of(terms);
  return sum;
}

Eigen::MatrixXd design_problem::hessian(const Eigen::VectorXd& x, const weights& given) {
  const std::size_t n = unknowns_.size();
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(unknowns(), unknowns());
  for (std::size_t first = 0; first < n; first += tangent::width) {
    const std::size_t last = std::min(n, first + tangent::width);
    std::vector<tangent> point(x.begin(), x.end());
    for (std::size_t k = first; k < last; ++k) point[k].slope[k - first] = 1.0;
    const auto m = form_of(point);
    auto gradient = empty_form<tangent>();
    const auto add_linear = [&](condition_sweep<tangent>& sweep, const Eigen::VectorXd& factors) {
      sweep.evaluate(m);
      for (std::size_t k = 0; k < sweep.size(); ++k)
        sweep.seed(k, tangent(factors(static_cast<Eigen::Index>(k))));
      sweep.reverse(gradient);
    };
    const auto add_squares = [&](measure what, double weight) {
      if (weight == 0.0) return;
      auto& sweep = terms_of(what).second;
      sweep.evaluate(m);
      for (std::size_t k = 0; k < sweep.size(); ++k) sweep.seed(k, tangent(weight) * sweep.residual(k));
      sweep.reverse(gradient);
    };
    add_linear(conditions_.second, given.equations);
    if (limits_) add_linear(limits_->second, given.limits);
    add_squares(measure::error, given.error);
    add_squares(measure::band, given.band);
    add_squares(measure::layer, given.layer);
    for (std::size_t u = 0; u < n; ++u)
      if (const tangent* from = entry(gradient, unknowns_[u]); from != nullptr)
        for (std::size_t k = first; k < last; ++k)
          H(static_cast<Eigen::Index>(u), static_cast<Eigen::Index>(k)) = from->slope[k - first];
  }
  return H;
}

}  // namespace apsis
