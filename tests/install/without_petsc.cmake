# Without PETSc, or with a version whose private headers differ, all components except petsc are configured.
include(${CMAKE_CURRENT_LIST_DIR}/support.cmake)
file(REMOVE_RECURSE ${WORK}/without_petsc)
configure(${SOURCE} ${WORK}/without_petsc -DAPSIS_TESTS=OFF -DCMAKE_DISABLE_FIND_PACKAGE_PETSc=TRUE)
if(NOT output MATCHES "The component petsc is not built")
  message(FATAL_ERROR "nothing is said of PETSc:\n${output}")
endif()
run(${CMAKE_COMMAND} --build ${WORK}/without_petsc --target help)
if(output MATCHES "\napsis_petsc:" OR NOT output MATCHES "\napsis_program:")
  message(FATAL_ERROR "apsis_petsc is built, or the program is not:\n${output}")
endif()
configure_fails("PETSc called with REQUIRED" ${SOURCE} ${WORK}/without_petsc -DAPSIS_COMPONENTS=petsc)

# Of another version, and with complex numbers.
function(write_petsc version scalars)
  set(prefix ${WORK}/other_petsc)
  file(REMOVE_RECURSE ${prefix} ${WORK}/without_petsc)
  file(WRITE ${prefix}/include/petsc/private/tsimpl.h "")
  file(WRITE ${prefix}/include/petscconf.h "#define PETSC_USE_REAL_DOUBLE 1\n${scalars}\n")
  file(WRITE ${prefix}/lib/libpetsc.so "")
  file(WRITE ${prefix}/lib/pkgconfig/petsc.pc "Name: PETSc\nDescription: PETSc\nVersion: ${version}\n"
    "Cflags: -I${prefix}/include\nLibs: -L${prefix}/lib -lpetsc\n")
endfunction()
set(ENV{PKG_CONFIG_PATH} ${WORK}/other_petsc/lib/pkgconfig)
write_petsc(3.24.0 "")
configure_fails("Found unsuitable version" ${SOURCE} ${WORK}/without_petsc -DAPSIS_COMPONENTS=petsc -DAPSIS_TESTS=OFF -DAPSIS_APP=OFF)
write_petsc(3.18.5 "#define PETSC_USE_COMPLEX 1")
configure_fails("PETSc does not compute with real numbers in double precision" ${SOURCE} ${WORK}/without_petsc
                -DAPSIS_COMPONENTS=petsc -DAPSIS_TESTS=OFF -DAPSIS_APP=OFF)
