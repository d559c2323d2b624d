#pragma once

#include <apsis/output/picture.hpp>
#include <apsis/study/convergence.hpp>

#include <string>

#include <nlohmann/json_fwd.hpp>

namespace apsis {

/// One block after the other, one line per run: the refined key, error, rate, steps, dt, cpu_s, min_value.
std::string to_text(const convergence_table& table);

/// One line per run: the varied keys, error, rate, steps, dt, wall_s, cpu_s, min_value, problem; 17
/// significant digits, an empty cell for NaN.
std::string to_csv(const convergence_table& table);

/// An array with one object per run, with the columns of the CSV; null for NaN, `problem` only if there
/// is one.
nlohmann::ordered_json to_json(const convergence_table& table);

/// Errors against the refined quantity on logarithmic axes, one curve per block, with triangles of the orders
/// of the methods. Of several other keys the one with the fewest values has one panel per value. Without
/// panels if no key is refined.
picture to_picture(const convergence_table& table);

}  // namespace apsis
