#include <apsis/config/internal/key_table.hpp>

namespace apsis {
namespace {

std::vector<case_key> output_keys() {
  return {
      key("output.every", [](auto& c) -> auto& { return c.output.every; },
          {.dimension = dimensions::time,
           .lowest = 0.0,
           .doc = "Time between snapshots of the fields; 0 keeps the final state only."}),
      key("output.fields", [](auto& c) -> auto& { return c.output.fields; },
          {.doc =
               "Names of the macroscopic fields to write; empty writes the usual ones of the model, of a gas "
               "rho, u, T, stress, heat_flux (with several velocity dimensions u_x, stress_xy, heat_flux_x, "
               "...). Further fields of a gas: p, mach, distance (to equilibrium), knudsen (local Knudsen "
               "number), divergence and vorticity of u (vorticity_x, ... with three velocity dimensions)."}),
      key("output.units", [](auto& c) -> auto& { return c.output.units; },
          {.scope = key_scope::velocity,
           .doc = "Units of fields, history and report: dimensionless, or those of the SI, with a table "
                  "[gas]. The distribution f, its velocities and checkpoints are dimensionless."}),
      key("output.distribution", [](auto& c) -> auto& { return c.output.distribution; },
          {.doc = "Where the unknowns themselves (f) are written: nowhere, at the end into solution.h5, or "
                  "also for every snapshot, into files of their own in snapshots/."}),
      if_given(key("output.distribution_at", [](auto& c) -> auto& { return c.output.distribution_at; },
                   {.scope = key_scope::space,
                    .dimension = dimensions::length,
                    .doc = "Points [[x, y], ...]: f is written in the cells that contain them, as points/f "
                           "of the file, and not in all cells."})),
      key("output.surfaces", [](auto& c) -> auto& { return c.output.surfaces; },
          {.scope = key_scope::space,
           .doc = "Names of faces (left, right, bottom, ...) that are not periodic and of solid boxes, or "
                  "\"all\": the fluxes of mass, momentum and energy from the gas to them in the last step, "
                  "per unit of time and area, with pressure, shear stress and heat flux, at every cell face, "
                  "in surfaces/NAME.csv."}),
      key("output.stride", [](auto& c) -> auto& { return c.output.stride; },
          {.unit = "cells",
           .lowest = 1,
           .highest = 10'000'000,
           .doc =
               "Snapshots of f contain every stride-th cell in each direction, beginning with the first."}),
      key("output.precision", [](auto& c) -> auto& { return c.output.precision; },
          {.doc = "Precision of snapshots of f. In single precision numbers have 7 digits and are 0 below "
                  "1e-45. The end and checkpoints have every digit."}),
      key("output.checkpoint_every", [](auto& c) -> auto& { return c.output.checkpoint_every; },
          {.unit = "steps",
           .lowest = 0,
           .highest = 1'000'000'000,
           .doc =
               "Steps between checkpoints; 0 writes none by steps. An interrupted run always leaves one."}),
      key("output.checkpoint_minutes", [](auto& c) -> auto& { return c.output.checkpoint_minutes; },
          {.unit = "minutes",
           .lowest = 0.0,
           .doc = "Minutes of wall time between checkpoints; 0 writes none by time."}),
      key("output.history_rows", [](auto& c) -> auto& { return c.output.history_rows; },
          {.unit = "rows",
           .lowest = 100,
           .highest = 10'000'000,
           .doc = "Most rows of the history. A run of more steps keeps every 2nd, 4th, 8th, … step, the last "
                  "one, and the steps at which a column is smallest or largest."})};
}

}  // namespace

extern const key_table_entry key_table_output;
const key_table_entry key_table_output = {.place = 90, .keys = output_keys};

}  // namespace apsis
