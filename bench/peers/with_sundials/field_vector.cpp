#include "field_vector.hpp"

#include <new>
#include <stdexcept>

#include <nvector/nvector_serial.h>

namespace apsis::bench::peers {
namespace {

/// The content that the operations of the serial vector use, and the field that owns `data`.
struct content : _N_VectorContent_Serial {
  explicit content(const field& from) : u(from) {
    length = static_cast<sunindextype>(u.cells()) * u.stride();
    own_data = SUNFALSE;
    data = u.row(0);
  }
  field u;
};

void destroy(N_Vector v) {
  if (v == nullptr) return;
  delete static_cast<content*>(static_cast<N_VectorContent_Serial>(v->content));
  v->content = nullptr;
  N_VFreeEmpty(v);
}

void set_content(N_Vector v, const field& u) {
  v->content = static_cast<N_VectorContent_Serial>(new content(u));
}

N_Vector clone(N_Vector w) {
  N_Vector v = N_VNewEmpty(w->sunctx);
  N_VCopyOps(w, v);
  set_content(v, field(field_of(w).cells(), field_of(w).components()));
  return v;
}

}  // namespace

owned_context make_context() {
  SUNContext made = nullptr;
  if (SUNContext_Create(nullptr, &made) != 0) throw std::runtime_error("SUNContext_Create failed");
  return owned_context(made);
}

owned_vector make_field_vector(const field& u, SUNContext context) {
  // Use the operations of an empty serial vector.
  const owned_vector serial(N_VNewEmpty_Serial(0, context));
  N_Vector v = N_VNewEmpty(context);
  N_VCopyOps(serial.get(), v);
  v->ops->nvclone = clone;
  v->ops->nvcloneempty = nullptr;
  v->ops->nvdestroy = destroy;
  set_content(v, u);
  return owned_vector(v);
}

field& field_of(N_Vector v) {
  return static_cast<content*>(static_cast<N_VectorContent_Serial>(v->content))->u;
}

}  // namespace apsis::bench::peers
