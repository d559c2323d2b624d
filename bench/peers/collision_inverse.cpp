#include "collision_inverse.hpp"

#include <utility>

namespace apsis::bench::peers {

namespace {

class bgk_inverse final : public collision_inverse {
 public:
  bgk_inverse(const relaxation_model& equation, std::vector<double> rates)
      : equation_(equation),
        rates_(std::move(rates)),
        states_(rates_.size()),
        maxwellians_(static_cast<int>(rates_.size()), equation.components()) {}

  void prepare(const field& f) override {
    for (int cell = 0; cell < f.cells(); ++cell) {
      double omega[3];
      equation_.moments(f.row(cell), omega);
      const double rho = omega[0], u = omega[1] / rho;
      states_[static_cast<std::size_t>(cell)] = {rho, u, 2.0 * omega[2] / rho - u * u};
      equation_.equilibrium(omega, maxwellians_.row(cell));
    }
  }

  void solve(double gamma, const field& r, field& z) const override {
    const double* v = equation_.speeds(0).data();
    for (int cell = 0; cell < r.cells(); ++cell) {
      const auto& at = states_[static_cast<std::size_t>(cell)];
      double omega[3];
      equation_.moments(r.row(cell), omega);
      // The differential of M in the direction of these moments is M (a + b(v − u) + c(v − u)²).
      const double d_rho = omega[0], d_u = (omega[1] - at.u * d_rho) / at.rho;
      const double d_T = (2.0 * omega[2] - (at.T + at.u * at.u) * d_rho) / at.rho - 2.0 * at.u * d_u;
      const double lambda = gamma * rates_[static_cast<std::size_t>(cell)], stay = 1.0 / (1.0 + lambda);
      const double add = lambda * stay;
      const double a = add * (d_rho / at.rho - 0.5 * d_T / at.T), b = add * d_u / at.T,
                   c = add * 0.5 * d_T / (at.T * at.T);
      const double *m = maxwellians_.row(cell), *from = r.row(cell);
      double* to = z.row(cell);
      const int n = r.components();
#pragma omp simd
      for (int j = 0; j < n; ++j) {
        const double x = v[j] - at.u;
        to[j] = stay * from[j] + m[j] * (a + x * (b + x * c));
      }
    }
  }

 private:
  struct fluid {
    double rho, u, T;
  };
  const relaxation_model& equation_;
  std::vector<double> rates_;
  std::vector<fluid> states_;
  field maxwellians_;
};

class broadwell_inverse final : public collision_inverse {
 public:
  explicit broadwell_inverse(std::vector<double> rates) : rates_(std::move(rates)) {}

  void prepare(const field& f) override { state_ = f; }

  void solve(double gamma, const field& r, field& z) const override {
    for (int cell = 0; cell < r.cells(); ++cell) {
      const double *f = state_.row(cell), *from = r.row(cell), rho = f[0] + 2.0 * f[1] + f[2];
      const double lambda = gamma * rates_[static_cast<std::size_t>(cell)];
      const double dq = 2.0 * f[1] * from[1] - f[2] * from[0] - f[0] * from[2];
      const double change = dq * lambda / (1.0 + lambda * rho);
      double* to = z.row(cell);
      to[0] = from[0] + change;
      to[1] = from[1] - change;
      to[2] = from[2] + change;
    }
  }

 private:
  std::vector<double> rates_;
  field state_;
};

}  // namespace

std::unique_ptr<collision_inverse> make_bgk_inverse(const relaxation_model& equation,
                                                    std::vector<double> rates) {
  return std::make_unique<bgk_inverse>(equation, std::move(rates));
}

std::unique_ptr<collision_inverse> make_broadwell_inverse(std::vector<double> rates) {
  return std::make_unique<broadwell_inverse>(std::move(rates));
}

}  // namespace apsis::bench::peers
