#pragma once

#include <apsis/device/device.hpp>
#include <apsis/mesh/field.hpp>
#include <apsis/mesh/grid.hpp>
#include <apsis/semidiscrete/transport.hpp>

#include <span>

namespace apsis {

/// sum ← (fresh ? 0 : sum) + Σ α u in the cells of the gas, for fields on the device.
void combine_rows(device& on, const grid& mesh, std::span<const linear_term<field, double>> terms, bool fresh,
                  field& sum);

}  // namespace apsis
