#pragma once

#include <apsis/model/general_model.hpp>
#include <apsis/semidiscrete/collision.hpp>

#include <memory>

namespace apsis {

/// The collision of a general model without space: every stage by guarded Newton (see
/// integrate/newton_problem.hpp).
std::unique_ptr<collision> make_newton_collision(const general_model& equation);

}  // namespace apsis
