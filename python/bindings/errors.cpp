#include <apsis/core/errors.hpp>

#include "arrays.hpp"

#include <apsis/core/printable.hpp>

#include <exception>
#include <utility>

namespace apsis::python {
namespace {

/// Raises one of the exceptions of apsis.errors, with the message of the library.
void raise(const char* name, const error& problem, const failure_site* site = nullptr) {
  const py::object type = py::module_::import("apsis.errors").attr(name);
  const py::object exception = type(printable(problem.what()));
  if (site != nullptr) {
    exception.attr("step") = site->step;
    exception.attr("t") = site->t;
    exception.attr("cell") = site->cell;
    exception.attr("value") = site->value;
  }
  PyErr_SetObject(type.ptr(), exception.ptr());
}

}  // namespace

void bind_errors(py::module_&) {
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(std::move(thrown));
    } catch (const numerical_error& problem) {
      raise("NumericalError", problem, &problem.site());
    } catch (const input_error& problem) {
      raise("InputError", problem);
    } catch (const io_error& problem) {
      raise("FileError", problem);
    } catch (const claim_error& problem) {
      raise("ClaimError", problem);
    }
  });
}

}  // namespace apsis::python
