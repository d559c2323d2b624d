#pragma once

#include <apsis/output/picture.hpp>
#include <apsis/study/convergence.hpp>

#include <string>

#include <nlohmann/json_fwd.hpp>

namespace apsis {

/// Returns the blocks as text, one line per run: the refined key, error, rate, steps, dt, cpu_s, min_value.
std::string to_text(const convergence_table& table);

/// Returns one line per run: the varied keys, error, rate, steps, dt, wall_s, cpu_s, min_value, problem.
/// Numbers have 17 significant digits; the cell of NaN is empty.
std::string to_csv(const convergence_table& table);

/// Returns an array with one object per run, with the columns of the CSV. NaN is null; `problem` is present
/// only if there is one.
nlohmann::ordered_json to_json(const convergence_table& table);

/// Returns a picture of the errors against the refined quantity on logarithmic axes. It has one curve per
/// block, and triangles of the orders of the methods. If several other keys vary, the one with the fewest
/// values has one panel per value. Without a refined key the picture has no panels.
picture to_picture(const convergence_table& table);

}  // namespace apsis
