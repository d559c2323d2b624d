#pragma once

namespace apsis {

/// Loops over the row of values at a face, for the instruction set of this processor. `inward` is v·n of
/// every component with the normal n into the domain.
namespace face_rows {

/// Sets the values to 0 except for components that leave.
void keep_leaving(const double* inward, int n, double* values);

/// Sets the values of components that enter to `entering`.
void take_entering(const double* inward, const double* entering, int n, double* values);

/// acc ← acc + β (v·n/Δx) values for components that enter.
void add_entering(const double* inward, const double* values, double beta, double spacing, int n,
                  double* acc);

/// values ← v·n values.
void multiply(const double* inward, int n, double* values);

}  // namespace face_rows
}  // namespace apsis
