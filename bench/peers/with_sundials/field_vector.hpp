#pragma once

#include <apsis/mesh/field.hpp>

#include <memory>

#include <sundials/sundials_context.h>
#include <sundials/sundials_nvector.h>

namespace apsis::bench::peers {

struct context_deleter {
  void operator()(SUNContext context) const { SUNContext_Free(&context); }
};
using owned_context = std::unique_ptr<_SUNContext, context_deleter>;
owned_context make_context();

struct vector_deleter {
  void operator()(N_Vector v) const { N_VDestroy(v); }
};
using owned_vector = std::unique_ptr<_generic_N_Vector, vector_deleter>;

/// Returns a serial vector of SUNDIALS with a copy of a field, padding included. Its operations act on the
/// rows in place, and right-hand sides get fields without copying. Clones are of the same kind.
owned_vector make_field_vector(const field& u, SUNContext context);

/// Returns the field of such a vector.
field& field_of(N_Vector v);

}  // namespace apsis::bench::peers
