#pragma once

namespace apsis {

/// Loops over the row of values at a face, for the instruction set of this processor. `inward` is v·n of
/// every component, n being the normal into the domain.
namespace face_rows {

/// Sets the values to 0 but where components leave.
void keep_leaving(const double* inward, int n, double* values);

/// Sets the values where components enter.
void take_entering(const double* inward, const double* entering, int n, double* values);

/// acc ← acc + β (v·n/Δx) values where components enter.
void add_entering(const double* inward, const double* values, double beta, double spacing, int n,
                  double* acc);

/// values ← v·n values.
void multiply(const double* inward, int n, double* values);

}  // namespace face_rows
}  // namespace apsis
