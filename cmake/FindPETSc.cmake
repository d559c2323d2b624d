# PETSc::PETSc, by pkg-config, with the MPI that its headers include. Without MPI, PETSc is not found. Neither is PETSc with complex
# numbers or with another precision than double. PETSC_WHY_NOT is the reason.
find_package(PkgConfig QUIET)
set(PETSC_WHY_NOT "")
if(PkgConfig_FOUND)
  pkg_search_module(PETSC_PKG QUIET petsc PETSc)
endif()
find_package(MPI QUIET COMPONENTS C)
# Time steppers are made with this header.
find_path(PETSC_INCLUDE_DIR petsc/private/tsimpl.h HINTS ${PETSC_PKG_INCLUDE_DIRS})
find_file(PETSC_CONFIGURATION petscconf.h HINTS ${PETSC_PKG_INCLUDE_DIRS})
mark_as_advanced(PETSC_INCLUDE_DIR PETSC_CONFIGURATION)
set(petsc_numbers OFF)
if(PETSC_CONFIGURATION)
  file(STRINGS ${PETSC_CONFIGURATION} petsc_scalars REGEX "define PETSC_USE_(COMPLEX|REAL_DOUBLE) ")
  if(petsc_scalars MATCHES "REAL_DOUBLE" AND NOT petsc_scalars MATCHES "COMPLEX")
    set(petsc_numbers ON)
  else()
    set(PETSC_WHY_NOT "PETSc does not compute with real numbers in double precision (another build of it is needed)")
  endif()
endif()
if(PETSC_PKG_FOUND AND NOT MPI_C_FOUND AND NOT PETSC_WHY_NOT)
  set(PETSC_WHY_NOT "PETSc needs MPI, which was not found")
endif()
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(PETSc REQUIRED_VARS PETSC_PKG_LINK_LIBRARIES PETSC_INCLUDE_DIR MPI_C_FOUND petsc_numbers
  VERSION_VAR PETSC_PKG_VERSION HANDLE_VERSION_RANGE REASON_FAILURE_MESSAGE "${PETSC_WHY_NOT}")
if(PETSc_FOUND AND NOT TARGET PETSc::PETSc)
  add_library(PETSc::PETSc INTERFACE IMPORTED)
  # Without the optimisation flags that pkg-config names.
  set_target_properties(PETSc::PETSc PROPERTIES
    INTERFACE_INCLUDE_DIRECTORIES "${PETSC_INCLUDE_DIR};${PETSC_PKG_INCLUDE_DIRS}"
    INTERFACE_LINK_LIBRARIES "${PETSC_PKG_LINK_LIBRARIES};MPI::MPI_C"
    # The C++ interface of MPI was removed from the standard.
    INTERFACE_COMPILE_DEFINITIONS "OMPI_SKIP_MPICXX;MPICH_SKIP_MPICXX")
endif()
