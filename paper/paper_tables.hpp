#pragma once

#include <apsis/method/tableau.hpp>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace apsis::paper {

/// A condition as the paper prints it, evaluated on a tableau, with its tree in our notation.
struct printed_condition {
  std::string tree;  ///< "G[F,G]"
  double left,       ///< left-hand side on the tableau
      right;         ///< right-hand side as printed
};

/// Returns the order conditions of two-derivative implicit methods up to order 4, as the paper prints them in
/// its b, c notation (section "Formulating the order conditions").
std::vector<printed_condition> printed_implicit_conditions(const butcher_form<double>& t);
/// Returns the order conditions of multi-derivative IMEX methods up to order 3, as the paper prints them
/// (section "Formulating order conditions").
std::vector<printed_condition> printed_imex_conditions(const butcher_form<double>& t);

/// An entry of a matrix, counted from 1 as in the paper.
struct printed_entry {
  std::size_t row,  ///< counted from 1
      column;       ///< counted from 1
  double value;     ///< value with all printed digits
};

/// The Butcher matrices that the paper prints for one of its methods; entries that are not listed are 0.
struct printed_tableau {
  std::string method;                ///< name of the method in the catalogue
  std::vector<printed_entry> A_hat,  ///< entries of Â; empty for implicit methods
      A,                             ///< entries of A
      A_dot;                         ///< entries of Ȧ
};

/// Returns the printed matrices of imdrk-2-3, imdrk-5-4 (with corrected indices), md-imex-3-2 or md-imex-6-3.
/// Throws input_error for other methods.
const printed_tableau& printed_butcher_form(const std::string& method);

/// Returns the largest distance of an entry of the method's Butcher form from the printed one.
double distance_to_print(const std::string& method);

/// Returns a lower triangular tableau, strictly in Â, with random entries in [−1, 1); the same on
/// every machine.
butcher_form<double> random_tableau(std::size_t stages, std::uint64_t seed);

}  // namespace apsis::paper
