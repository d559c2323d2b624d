#pragma once

#include <apsis/boundary/domain.hpp>
#include <apsis/mesh/grid.hpp>
#include <apsis/model/model.hpp>
#include <apsis/model/source_rate.hpp>
#include <apsis/semidiscrete/cell_unknown.hpp>

#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace apsis {

/// Parts of a problem in axisymmetric flow. The unknowns are F = r f. The distance r from the axis is the
/// coordinate of the direction `radial` of the mesh. With v_r = v_⊥ cos ω and v_θ = v_⊥ sin ω they satisfy
///     F_t + v_x F_x + v_r F_r − (1/r) ∂_ω(v_⊥ sin ω F) = r Q(f)/ε.
/// Transport through cells is therefore that of a plane. Data in terms of f change as follows.
namespace axisymmetric {

/// Throws input_error unless the velocities have rings, and the last of one or two directions is radial. The
/// mesh must have r ≥ 0. Its lower end must be the axis if r = 0 there, and only then. Without `radial`, for
/// other flows, throws if an end is an axis.
void check(const model& equation, const grid& whole, const std::optional<int>& radial,
           const std::vector<domain::faces>& sides, const cell_unknown& unknown);

/// Returns the conditions for F; the axis stays unchanged.
std::vector<domain::faces> sides_of(std::vector<domain::faces> sides, int radial, const grid& mesh);
/// Returns the conditions for F at solid boxes and bodies.
std::vector<std::shared_ptr<const boundary>> walls_of(std::vector<std::shared_ptr<const boundary>> walls,
                                                      int radial, const grid& mesh);

/// Returns ε(x) such that Q(F)/ε is r Q(f)/ε: r ε if the collision rate is proportional to the
/// density, else ε.
std::function<double(const position&)> epsilon_of(std::function<double(const position&)> epsilon,
                                                  const model& equation, int radial);

/// Returns the data r f.
state_function data_of(const state_function& f, int radial);

/// Returns the source r S(t, x, F/r).
source_rate source_of(source_rate of, int radial);

}  // namespace axisymmetric
}  // namespace apsis
