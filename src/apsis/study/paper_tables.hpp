#pragma once

#include <apsis/method/tableau.hpp>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace apsis {

/// A condition as the paper prints it, evaluated on a tableau, with its tree in our notation.
struct printed_condition {
  std::string tree;
  double left, right;
};

/// The tables of order conditions, typed from the page in its b, c notation: two-derivative implicit methods
/// up to order 4 (section "Formulating the order conditions"), multi-derivative IMEX methods up to order 3
/// (section "Formulating order conditions").
std::vector<printed_condition> printed_implicit_conditions(const butcher_form<double>& t);
std::vector<printed_condition> printed_imex_conditions(const butcher_form<double>& t);

/// An entry of a matrix, counted from 1 as the page does.
struct printed_entry {
  std::size_t row, column;
  double value;
};

/// The Butcher matrices that the paper prints for one of its methods; entries that are not listed are 0.
struct printed_tableau {
  std::string method;
  std::vector<printed_entry> A_hat, A, A_dot;
};

/// Of imdrk-2-3, imdrk-5-4 (with the swapped indices of the page put right), md-imex-3-2, md-imex-6-3.
const printed_tableau& printed_butcher_form(const std::string& method);

/// Largest distance of an entry of the method's Butcher form from the printed one.
double distance_to_print(const std::string& method);

/// A tableau with no structure but its triangles, entries in (−1, 1); the same on every machine.
butcher_form<double> random_tableau(std::size_t stages, std::uint64_t seed);

}  // namespace apsis
