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

/// Parts of a problem in axisymmetric flow. The unknowns are F = r f, with the distance r from the axis,
/// which is the coordinate x_k of a direction k = `radial` of the mesh. With v_r = v_⊥ cos ω and v_θ = v_⊥
/// sin ω they satisfy
///     F_t + v_x F_x + v_r F_r − (1/r) ∂_ω(v_⊥ sin ω F) = r Q(f)/ε,
/// Hence transport through cells is that of a plane. Data in terms of f change as follows.
namespace axisymmetric {

/// Throws input_error unless the velocities have rings and the last direction of one or two is radial. The
/// mesh must have r ≥ 0, and its lower end must be the axis where r = 0, and nowhere else. Without `radial`,
/// for other flows, it throws if an end is an axis.
void check(const model& equation, const grid& whole, const std::optional<int>& radial,
           const std::vector<domain::faces>& sides, const cell_unknown& unknown);

/// Returns the conditions for F; the axis stays.
std::vector<domain::faces> sides_of(std::vector<domain::faces> sides, int radial, const grid& mesh);
/// Returns the conditions for F at solid boxes and bodies.
std::vector<std::shared_ptr<const boundary>> walls_of(std::vector<std::shared_ptr<const boundary>> walls,
                                                      int radial, const grid& mesh);

/// Returns ε(x) with which Q(F)/ε is r Q(f)/ε: r ε where the collision rate is proportional to the density,
/// else ε.
std::function<double(const position&)> epsilon_of(std::function<double(const position&)> epsilon,
                                                  const model& equation, int radial);

/// Returns the data r f.
state_function data_of(const state_function& f, int radial);

/// Returns the source r S(t, x, F/r).
source_rate source_of(source_rate of, int radial);

}  // namespace axisymmetric
}  // namespace apsis
