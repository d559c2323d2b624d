#pragma once

#include <apsis/config/case.hpp>

#include <functional>
#include <optional>
#include <string>

namespace apsis::paper {

/// A limit system written out by hand, ω_t + F(ω)_x = S(ω), as in the paper's summary of the models. It is
/// independent of moments, equilibrium and transport of the model.
struct limit_equations {
  std::string name;  ///< "compressible Euler equations"
  int unknowns = 0;  ///< numbers in ω
  /// F(ω); empty without space.
  std::function<void(const double* omega, double* flux)> flux;
  /// S(ω); empty if there is no source.
  std::function<void(const double* omega, double* source)> source;
};

/// Returns the limit system of the case's model; nothing for a model whose limit is not written here.
///  - ode: u1' = sin u1
///  - relaxation (paper, eq. hr): u1_t + F(u1)_x = 0, F linear, of Burgers or of Buckley and Leverett
///  - broadwell (paper, eq. broadlimit): ρ_t + m_x = 0, m_t + ((ρ² + m²)/(2ρ))_x = 0
///  - bgk (paper, eq. euler): ρ_t + (ρu)_x = 0, (ρu)_t + (ρu² + p)_x = 0, 𝓔_t + ((𝓔 + p)u)_x = 0, p = ρT,
///    𝓔 = ½ρu² + (d/2)ρT for d velocity dimensions, momenta across x carried along
std::optional<limit_equations> written_limit(const case_config& config);

}  // namespace apsis::paper
