// Advection, diffusion and stiff exchange of two species on a periodic line. Each process has a part
// of the vectors.
#pragma once

#include <apsis/apsis_sundials.h>

#include <cmath>
#include <cstddef>
#include <functional>
#include <vector>

namespace line_test {

/// u_t + c u_x = D u_xx − (u² − w)/ε, w_t + c w_x = D w_xx + (u² − w)/ε on [0, 1). If `linear`, u replaces
/// u². T is the advection by first-order upwind differences. The vector has u and w of cell 0, of cell 1, …
struct line {
  std::ptrdiff_t cells = 0, begin = 0, end = 0;  ///< all cells, and those of this process
  double speed = 1.0, diffusion = 0.0, epsilon = 1.0;
  /// Sets the last two numbers of the previous process and the first two of the next one.
  std::function<void(const double* own, std::size_t n, double before[2], double after[2])> exchange =
      [](const double* own, std::size_t n, double before[2], double after[2]) {
        for (int k = 0; k < 2; ++k) {
          before[k] = own[n - 2 + static_cast<std::size_t>(k)];
          after[k] = own[k];
        }
      };
  bool linear = false;
  long preconditioned_gammas = 0;
  std::vector<double> inverse{};  ///< inverse blocks of the preconditioner, four numbers per cell

  std::size_t own() const { return static_cast<std::size_t>(end - begin); }
  double exchanged(double u) const { return linear ? u : u * u; }
  double slope(double u) const { return linear ? 1.0 : 2.0 * u; }
  double dx() const { return 1.0 / static_cast<double>(cells); }

  /// Returns the values of this process with those of one more cell at either end.
  std::vector<double> with_neighbours(const double* v) const {
    std::vector<double> all(2 * own() + 4);
    for (std::size_t i = 0; i < 2 * own(); ++i) all[i + 2] = v[i];
    double before[2], after[2];
    exchange(v, 2 * own(), before, after);
    for (std::size_t k = 0; k < 2; ++k) {
      all[k] = before[k];
      all[2 * own() + 2 + k] = after[k];
    }
    return all;
  }
};

inline double* numbers(N_Vector v) {
  return N_VGetArrayPointer(v);
}

/// Sets smooth positive data out of equilibrium.
inline void start(const line& of, N_Vector y) {
  for (std::size_t i = 0; i < of.own(); ++i) {
    const double x = (static_cast<double>(of.begin) + static_cast<double>(i) + 0.5) * of.dx();
    numbers(y)[2 * i] = 1.0 + 0.5 * std::sin(2.0 * M_PI * x);
    numbers(y)[2 * i + 1] = 1.0 + 0.3 * std::cos(2.0 * M_PI * x);
  }
}

inline int transport(double, N_Vector y, N_Vector out, void* data) {
  const auto& of = *static_cast<const line*>(data);
  const auto v = of.with_neighbours(numbers(y));
  for (std::size_t i = 0; i < 2 * of.own(); ++i) numbers(out)[i] = -of.speed * (v[i + 2] - v[i]) / of.dx();
  return 0;
}

inline int collision(double, N_Vector y, N_Vector out, void* data) {
  const auto& of = *static_cast<const line*>(data);
  const auto v = of.with_neighbours(numbers(y));
  const double d = of.diffusion / (of.dx() * of.dx());
  for (std::size_t i = 0; i < of.own(); ++i) {
    const double u = v[2 * i + 2], w = v[2 * i + 3], rate = (of.exchanged(u) - w) / of.epsilon;
    for (std::size_t k = 0; k < 2; ++k) {
      const std::size_t j = 2 * i + k;
      numbers(out)[j] = d * (v[j] - 2.0 * v[j + 2] + v[j + 4]) + (k == 0 ? -rate : rate);
    }
  }
  return 0;
}

inline int product(N_Vector x, N_Vector jx, double, N_Vector y, N_Vector, void* data, N_Vector) {
  const auto& of = *static_cast<const line*>(data);
  const auto v = of.with_neighbours(numbers(x));
  const double d = of.diffusion / (of.dx() * of.dx());
  for (std::size_t i = 0; i < of.own(); ++i) {
    const double rate = (of.slope(numbers(y)[2 * i]) * v[2 * i + 2] - v[2 * i + 3]) / of.epsilon;
    for (std::size_t k = 0; k < 2; ++k) {
      const std::size_t j = 2 * i + k;
      numbers(jx)[j] = d * (v[j] - 2.0 * v[j + 2] + v[j + 4]) + (k == 0 ? -rate : rate);
    }
  }
  return 0;
}

/// Inverts the 2 × 2 diagonal blocks of I − γJ.
inline int precondition_setup(double, N_Vector y, N_Vector, int, int* current, double gamma, void* data) {
  auto& of = *static_cast<line*>(data);
  const double d = 2.0 * of.diffusion / (of.dx() * of.dx());
  of.inverse.resize(4 * of.own());
  for (std::size_t i = 0; i < of.own(); ++i) {
    const double to_u = of.slope(numbers(y)[2 * i]) / of.epsilon, to_w = -1.0 / of.epsilon;
    const double a = 1.0 + gamma * (d + to_u), b = gamma * to_w, c = -gamma * to_u,
                 e = 1.0 + gamma * (d - to_w);
    const double det = a * e - b * c;
    const double block[] = {e / det, -b / det, -c / det, a / det};
    for (std::size_t k = 0; k < 4; ++k) of.inverse[4 * i + k] = block[k];
  }
  ++of.preconditioned_gammas;
  *current = 1;
  return 0;
}

inline int precondition(double, N_Vector, N_Vector, N_Vector r, N_Vector z, double, double, int, void* data) {
  const auto& of = *static_cast<const line*>(data);
  for (std::size_t i = 0; i < of.own(); ++i) {
    const double* m = &of.inverse[4 * i];
    const double first = numbers(r)[2 * i], second = numbers(r)[2 * i + 1];
    numbers(z)[2 * i] = m[0] * first + m[1] * second;
    numbers(z)[2 * i + 1] = m[2] * first + m[3] * second;
  }
  return 0;
}

inline int forward_euler_step(N_Vector, double, double* result, void* data) {
  const auto& of = *static_cast<const line*>(data);
  *result = of.dx() / of.speed;
  return 0;
}

}  // namespace line_test
