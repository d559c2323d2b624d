# One library per room of src/apsis, static or shared as BUILD_SHARED_LIBS says. A room may link only the rooms below it,
# so an include that reaches back does not link and the direction of the data flow is kept by the build.
#
#   apsis_room(method COMPONENT integrate DEPENDS core PUBLIC Boost::headers PRIVATE tomlplusplus::tomlplusplus)
#
# PUBLIC and PRIVATE as in target_link_libraries; INSIDE is for packages of headers that only sources read, which users
# of the installed library therefore need not have. The component is kinetic if not given; a room of a component that is
# not built (ApsisComponents.cmake) is skipped.

add_library(apsis_options INTERFACE)
target_compile_features(apsis_options INTERFACE cxx_std_20)
# As Boost::headers has it; a precompiled header wants it in all files or in none.
target_compile_definitions(apsis_options INTERFACE BOOST_ALL_NO_LIB)
# Kernels are compiled for the plain architecture, 256 and 512 bit (exec/simd-inl.hpp); what lies between, or differs in
# instructions that no kernel uses, only costs time to build.
target_compile_definitions(apsis_options INTERFACE
  "HWY_DISABLED_TARGETS=(HWY_SSSE3|HWY_SSE4|HWY_AVX3_DL)")
target_compile_options(apsis_options INTERFACE
  -Wall -Wextra -Wshadow -Wconversion
  $<$<BOOL:${APSIS_WERROR}>:-Werror>
  -fno-math-errno
  # g++-12 sees overlaps in its own std::string (GCC bug 105651), and more of them once headers are precompiled.
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>
  "$<$<AND:$<CXX_COMPILER_ID:GNU>,$<BOOL:${APSIS_PCH}>>:-Wno-array-bounds;-Wno-stringop-overflow;-Wno-stringop-overread>")

# What only calls the rooms (program, tests) gains nothing from optimisation but time to build.
set(APSIS_QUICKLY_BUILT $<$<CONFIG:Release>:-O1>)
# Rooms without loops over cells: -O3 costs time to build and makes nothing faster.
set(APSIS_PLAIN $<$<CONFIG:Release>:-O2>)

# Rooms with loops over cells and velocities. Their headers keep no type whose layout depends on the instruction
# set, so other targets are built for the plain architecture and link with them safely.
add_library(apsis_kernel_options INTERFACE)
target_compile_options(apsis_kernel_options INTERFACE
  -O3 -fopenmp-simd -fno-trapping-math
  # A number must be rounded alike in the middle and at the end of a row, where other loops treat it: fma where the
  # source says so, nowhere else.
  -ffp-contract=off
  # Sanitizers keep clang from vectorising some loops; that is no reason to fail there.
  $<$<CXX_COMPILER_ID:Clang>:-Wno-pass-failed>)

# Headers that most files read, for seconds each (see APSIS_PCH). Rooms with kernels have other flags and go
# without.
if(APSIS_PCH)
  file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/generated/precompiled.cpp CONTENT "")
  add_library(apsis_precompiled STATIC ${PROJECT_BINARY_DIR}/generated/precompiled.cpp)
  set_target_properties(apsis_precompiled PROPERTIES POSITION_INDEPENDENT_CODE ON CXX_EXTENSIONS OFF)
  target_link_libraries(apsis_precompiled PRIVATE apsis_options Boost::headers fmt::fmt)
  target_compile_options(apsis_precompiled PRIVATE ${APSIS_PLAIN})
  target_precompile_headers(apsis_precompiled PRIVATE
    <algorithm> <array> <cmath> <functional> <limits> <map> <memory> <optional> <span> <string> <utility> <vector>
    <boost/multiprecision/cpp_bin_float.hpp> <fmt/format.h> <fmt/ranges.h>)
endif()

function(apsis_room name)
  cmake_parse_arguments(ROOM "KERNELS" "COMPONENT" "DEPENDS;PUBLIC;PRIVATE;INSIDE;GENERATED" ${ARGN})
  if(NOT ROOM_COMPONENT)
    set(ROOM_COMPONENT kinetic)
  endif()
  if(NOT ROOM_COMPONENT IN_LIST apsis_parts)
    return()
  endif()
  set_property(GLOBAL APPEND PROPERTY APSIS_ROOMS_${ROOM_COMPONENT} ${name})
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${name}/*.cpp
       ${CMAKE_CURRENT_SOURCE_DIR}/${name}/*/*.cpp)
  add_library(apsis_${name} ${sources} ${ROOM_GENERATED})
  add_library(apsis::${name} ALIAS apsis_${name})
  set_target_properties(apsis_${name} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON CXX_EXTENSIONS OFF
    # What a room exports is not marked, so all of it is, whatever a project around this one prefers.
    CXX_VISIBILITY_PRESET default VISIBILITY_INLINES_HIDDEN OFF
    # Static and shared libraries are compiled alike.
    DEFINE_SYMBOL "")
  get_target_property(type apsis_${name} TYPE)
  if(type STREQUAL SHARED_LIBRARY)
    # Before 1.0 a minor version may change the interface.
    set_target_properties(apsis_${name} PROPERTIES INSTALL_RPATH "$ORIGIN" VERSION ${PROJECT_VERSION}
      SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
  endif()
  target_compile_features(apsis_${name} PUBLIC cxx_std_20)
  target_include_directories(apsis_${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/src> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  list(TRANSFORM ROOM_DEPENDS PREPEND apsis_)
  list(TRANSFORM ROOM_INSIDE REPLACE "(.+)" "$<BUILD_INTERFACE:\\1>")
  target_link_libraries(apsis_${name} PUBLIC ${ROOM_DEPENDS} ${ROOM_PUBLIC})
  target_link_libraries(apsis_${name} PRIVATE $<BUILD_INTERFACE:apsis_options> ${ROOM_PRIVATE} ${ROOM_INSIDE})
  if(ROOM_KERNELS)
    target_link_libraries(apsis_${name} PRIVATE $<BUILD_INTERFACE:apsis_kernel_options>)
  else()
    target_compile_options(apsis_${name} PRIVATE ${APSIS_PLAIN})
    if(APSIS_PCH)
      target_precompile_headers(apsis_${name} REUSE_FROM apsis_precompiled)
    endif()
  endif()
endfunction()
