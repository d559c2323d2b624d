#include "internal/callbacks.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include <fmt/format.h>

namespace apsis::c {

void callbacks::evaluate_transport(double t, const std::vector<double>& u, std::vector<double>& out) {
  out.resize(u.size());
  if (transport == nullptr) {
    std::fill(out.begin(), out.end(), 0.0);
    return;
  }
  count(APSIS_TRANSPORT_EVALUATIONS);
  require_success("transport", transport(t, u.size(), u.data(), out.data(), data));
  require_finite(out, "the result of the callback 'transport'");
}

void callbacks::evaluate_block(double t, std::size_t block, std::span<const double> u, std::span<double> q) {
  if (!has_rate()) {  // Q = 0: make_run() accepts nothing else without a rate
    std::fill(q.begin(), q.end(), 0.0);
    return;
  }
  count(APSIS_RATE_EVALUATIONS);
  require_success("rate", timed_rate != nullptr ? timed_rate(t, block, u.size(), u.data(), q.data(), data)
                                                : rate(block, u.size(), u.data(), q.data(), data));
}

void callbacks::evaluate_rate(double t, const std::vector<double>& u, std::vector<double>& out) {
  out.resize(u.size());
  const std::span<const double> all(u);
  const std::span<double> rates(out);
  for (std::size_t block = 0; block * block_size < u.size(); ++block)
    evaluate_block(t, block, all.subspan(block * block_size, block_size),
                   rates.subspan(block * block_size, block_size));
  require_finite(out, "the result of the callback 'rate'");
}

shifted_solve<double> callbacks::solver_of(std::size_t block, double t, std::span<const double> u,
                                           double gamma) {
  const auto ready = std::make_shared<long long>(0);
  return [this, block, t, gamma, ready, at = std::vector<double>(u.begin(), u.end())](
             std::span<const double> r, std::span<double> x) {
    if (prepare != nullptr && (*ready == 0 || *ready != preparation)) {
      *ready = ++preparation;
      count(APSIS_PREPARATIONS);
      require_success("prepare", prepare(t, gamma, block, at.size(), at.data(), data));
    }
    count(APSIS_PRECONDITIONER_SOLVES);
    require_success("solve", precondition(t, gamma, block, at.size(), at.data(), r.data(), x.data(), data));
  };
}

bool callbacks::is_admissible(std::size_t block, std::span<const double> u) const {
  if (admissible == nullptr) return true;
  int result = 0;
  require_success("admissible", admissible(block, u.size(), u.data(), &result, data));
  return result != 0;
}

std::optional<std::size_t> callbacks::first_inadmissible(const std::vector<double>& u) const {
  if (admissible == nullptr) return std::nullopt;
  const std::span<const double> all(u);
  for (std::size_t block = 0; block * block_size < u.size(); ++block)
    if (!is_admissible(block, all.subspan(block * block_size, block_size))) return block;
  return std::nullopt;
}

void callbacks::require_valid(const std::vector<double>& u) const {
  require_finite(u, "a stage");
  if (const auto block = first_inadmissible(u))
    throw numerical_error(
        "a stage is not admissible (the method or the time step does not preserve admissibility); use Δt ≤ r "
        "Δt_FE with an SSP method",
        {-1, std::nan(""), u.size() > block_size ? static_cast<long>(*block) : -1, std::nan("")});
}

double callbacks::time_of(apsis_time_function* function, const char* name, double t,
                          const std::vector<double>& u) const {
  double result = std::numeric_limits<double>::infinity();
  if (function == nullptr) return result;
  require_success(name, function(t, u.size(), u.data(), &result, data));
  if (!(result > 0.0))
    throw numerical_error(
        fmt::format("the callback '{}' gives the time {} (a positive number is needed); check the "
                    "callback",
                    name, result));
  return result;
}

}  // namespace apsis::c
