#include <apsis/semidiscrete/boundary_budget.hpp>

#include <algorithm>
#include <cstddef>

namespace apsis {

void boundary_budget::scale(double factor) {
  for (double& amount : amounts_) amount *= factor;
}

void boundary_budget::add(double factor, std::span<const double> amounts) {
  amounts_.resize(std::max(amounts_.size(), amounts.size()));
  for (std::size_t k = 0; k < amounts.size(); ++k) amounts_[k] += factor * amounts[k];
}

void boundary_budget::combine(double alpha, const boundary_budget& of, double beta,
                              std::span<const double> rates, bool fresh) {
  if (fresh && &of == this) return scale(alpha);
  if (fresh) clear();
  amounts_.resize(std::max({amounts_.size(), of.amounts_.size(), rates.size()}));
  add(alpha, of.amounts_);
  add(beta, rates);
}

}  // namespace apsis
