# The components of the package, the selection to build, and the packages that each requires. The rooms of src/apsis name
# their component (see ApsisRoom.cmake); apsisConfig.cmake finds the same packages again.
#   integrate   the methods and the time integrator, for any problem
#   kinetic     the solver of kinetic equations
#   design      the search for new methods
#   c           the C interface of integrate, a shared library
#   petsc       the time stepper "apsis" of PETSc, a shared library
# exec cannot be requested as a component; it is the common part of kinetic and design.
set(apsis_components integrate kinetic design c petsc)
foreach(component IN LISTS APSIS_COMPONENTS)
  if(NOT component IN_LIST apsis_components)
    list(JOIN apsis_components ", " valid)
    message(FATAL_ERROR "APSIS_COMPONENTS: unknown component '${component}' (there is no such component); valid: ${valid}")
  endif()
endforeach()

if(APSIS_COMPONENTS)
  set(apsis_components ${APSIS_COMPONENTS})
endif()
if(NOT "integrate" IN_LIST apsis_components)
  list(PREPEND apsis_components integrate)
endif()
if("design" IN_LIST apsis_components)
  if(APSIS_COMPONENTS)
    find_package(Ipopt REQUIRED)
  else()
    find_package(Ipopt)
  endif()
  if(NOT Ipopt_FOUND)
    message(STATUS "The component design is not built (Ipopt was not found)")
    list(REMOVE_ITEM apsis_components design)
  endif()
endif()
# The private headers that time steppers need change with every minor version.
set(apsis_petsc_versions 3.18...<3.19)
if("petsc" IN_LIST apsis_components)
  if(APSIS_COMPONENTS)
    find_package(PETSc ${apsis_petsc_versions} REQUIRED)
  else()
    find_package(PETSc ${apsis_petsc_versions})
  endif()
  if(NOT PETSc_FOUND)
    message(STATUS "The component petsc is not built (PETSc ${apsis_petsc_versions} was not found)")
    list(REMOVE_ITEM apsis_components petsc)
  endif()
endif()

# In order of dependence.
set(apsis_parts "")
foreach(part integrate exec kinetic design c petsc)
  if(part IN_LIST apsis_components OR (part STREQUAL exec AND apsis_components MATCHES "kinetic|design"))
    list(APPEND apsis_parts ${part})
  endif()
endforeach()

# Processes write their parts of a file one by one, with the serial HDF5.
set(apsis_mpi OFF)
if(NOT APSIS_MPI MATCHES "^(ON|OFF|AUTO)$")
  message(FATAL_ERROR "APSIS_MPI: '${APSIS_MPI}' (there is no such choice); valid: ON, OFF, AUTO")
endif()
if("kinetic" IN_LIST apsis_components AND NOT APSIS_MPI STREQUAL "OFF")
  if(APSIS_MPI STREQUAL "ON")
    find_package(MPI REQUIRED COMPONENTS C)
  else()
    find_package(MPI QUIET COMPONENTS C)
  endif()
  set(apsis_mpi ${MPI_C_FOUND})
  if(NOT apsis_mpi)
    message(STATUS "Runs on several processes are not built (MPI was not found)")
  endif()
endif()
# A parallel HDF5 that an earlier configuration found must not hide the serial one.
set(HDF5_PREFER_PARALLEL OFF)
if(DEFINED CACHE{HDF5_C_COMPILER_EXECUTABLE} AND HDF5_C_COMPILER_EXECUTABLE MATCHES "h5pcc")
  unset(HDF5_C_COMPILER_EXECUTABLE CACHE)
  unset(HDF5_C_LIBRARY_hdf5 CACHE)
endif()

# Packages with headers or libraries in the interface: users of the component also find them.
set(apsis_packages_integrate fmt "Boost 1.74")
set(apsis_packages_exec hwy Threads)
set(apsis_packages_kinetic "Boost 1.74" nlohmann_json)
set(apsis_packages_design "Eigen3 NO_MODULE")
set(apsis_packages_petsc "PETSc ${apsis_petsc_versions}")
# Libraries that only sources use: users of static libraries link them.
set(apsis_link_packages_integrate tomlplusplus)
set(apsis_link_packages_kinetic tomlplusplus muparser "HDF5 COMPONENTS C")
set(apsis_link_packages_design Ipopt)
if(apsis_mpi)
  set(apsis_link_packages_exec "MPI COMPONENTS C")
endif()
# Headers that only sources read.
set(apsis_build_packages_integrate "Eigen3 NO_MODULE")
set(apsis_build_packages_kinetic "Eigen3 NO_MODULE")

foreach(part IN LISTS apsis_parts)
  foreach(package IN LISTS apsis_packages_${part} apsis_link_packages_${part} apsis_build_packages_${part})
    separate_arguments(package)
    find_package(${package} REQUIRED)
  endforeach()
endforeach()
