#pragma once

#include <apsis/method/certificate.hpp>

namespace apsis {

/// Compares the claimed order with the order and the conditions of the certificate, and appends differences
/// to c.failures.
void check_order_claim(const method& m, certificate& c);

/// Compares the claims of a method with its certificate so far: order, SSP coefficient and explicit radius,
/// the form of the file, type and L-stability, and the terms of size ε. Appends differences to c.failures.
/// `form` is that of the file, `tolerance` the largest admissible residual.
void check_claims(const method& m, const shu_osher_form<mp_real>& form, const mp_real& tolerance,
                  certificate& c);

}  // namespace apsis
