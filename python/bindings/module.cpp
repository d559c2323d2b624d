#include "arrays.hpp"

#include <apsis/core/log.hpp>

PYBIND11_MODULE(_core, m) {
  m.doc() = "Compiled part of the package apsis; use the package.";
  // A library says nothing that was not asked for.
  apsis::log::set_level(apsis::log::level::warning);
  apsis::python::bind_errors(m);
  apsis::python::bind_warnings(m);
  apsis::python::bind_methods(m);
  apsis::python::bind_integrate(m);
  apsis::python::bind_general(m);
  apsis::python::bind_evolution(m);
  apsis::python::bind_runs(m);
  apsis::python::bind_kinetic(m);
}
