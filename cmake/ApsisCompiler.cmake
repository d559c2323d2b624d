# The compiler. APSIS_PREFERRED_COMPILERS, which a preset may set, names a C and a C++ compiler: the build uses them if both are
# installed and nothing else chooses a compiler (CC, CXX, CMAKE_C_COMPILER, CMAKE_CXX_COMPILER, a toolchain file). Without it the
# default of CMake applies. To be included before project(), which looks for compilers.
function(apsis_prefer_compilers)
  set(chosen "${CMAKE_C_COMPILER}${CMAKE_CXX_COMPILER}${CMAKE_TOOLCHAIN_FILE}$ENV{CC}$ENV{CXX}$ENV{CMAKE_TOOLCHAIN_FILE}")
  list(LENGTH APSIS_PREFERRED_COMPILERS number)
  if(NOT number EQUAL 2 OR NOT chosen STREQUAL "")
    return()
  endif()
  list(GET APSIS_PREFERRED_COMPILERS 0 name_of_c)
  list(GET APSIS_PREFERRED_COMPILERS 1 name_of_cxx)
  find_program(apsis_preferred_c ${name_of_c} NO_CACHE)
  find_program(apsis_preferred_cxx ${name_of_cxx} NO_CACHE)
  if(apsis_preferred_c AND apsis_preferred_cxx)
    set(CMAKE_C_COMPILER ${apsis_preferred_c} CACHE STRING "C compiler")
    set(CMAKE_CXX_COMPILER ${apsis_preferred_cxx} CACHE STRING "C++ compiler")
  endif()
endfunction()
apsis_prefer_compilers()

# Ends the configuration, with one message, if the C++ compiler lacks features of C++20 in the sources.
function(apsis_check_compiler)
  set(reason "CMake has no flag of C++20 for it")
  if("cxx_std_20" IN_LIST CMAKE_CXX_COMPILE_FEATURES)
    set(reason "it does not compile a test of C++20, cmake/cxx20.cpp")
    if(NOT APSIS_HAS_CXX20)
      message(CHECK_START "Checking the C++20 of ${CMAKE_CXX_COMPILER}")
      # Only compiled, since warnings and linkers are not the subject.
      set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
      try_compile(APSIS_HAS_CXX20 ${CMAKE_CURRENT_BINARY_DIR}/cxx20 SOURCES ${CMAKE_CURRENT_SOURCE_DIR}/cmake/cxx20.cpp
                  CXX_STANDARD 20 CXX_STANDARD_REQUIRED ON CXX_EXTENSIONS OFF OUTPUT_VARIABLE output)
      if(APSIS_HAS_CXX20)
        message(CHECK_PASS "sufficient")
      else()
        message(CHECK_FAIL "insufficient")
        file(APPEND ${CMAKE_BINARY_DIR}/CMakeFiles/CMakeError.log "cmake/cxx20.cpp:\n${output}\n")
      endif()
    endif()
  endif()
  if(NOT APSIS_HAS_CXX20)
    message(FATAL_ERROR "cannot compile with '${CMAKE_CXX_COMPILER}', ${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION} "
      "(${reason}); select a compiler with complete C++20, such as g++-12 or clang++-19, in a new build folder by "
      "CC and CXX or by -DCMAKE_C_COMPILER=… -DCMAKE_CXX_COMPILER=…")
  endif()
endfunction()
