#pragma once

#include <apsis/method/multistage_formula.hpp>

namespace apsis {

/// Returns the IMEX-DIMSIM of order p = 2 or 3, with p stages and stage order p. Its implicit part is an
/// L-stable diagonally implicit multistage integration method of type 2 (Butcher, Appl. Numer. Math. 11
/// (1993) 347–363; Butcher, Jackiewicz, Appl. Numer. Math. 21 (1996) 385–415). Its explicit part has the same
/// abscissae and the same V (Zhang, Sandu, Blaise, J. Sci. Comput. 61 (2014) 119–144). Â was chosen here
/// for long steps with a fifth-order upwind difference and any w ≤ 0. Signs are not preserved: V, A and B
/// have negative entries. Throws input_error for another p.
multistage_formula<mp_real> imex_dimsim_coefficients(int p);

}  // namespace apsis
