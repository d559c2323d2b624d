# One library per room of src/apsis, static or shared according to BUILD_SHARED_LIBS. A room may link only the rooms below it,
# so an include of a room above does not link, and the build enforces the direction of the data flow.
#
#   apsis_room(method COMPONENT integrate DEPENDS core PUBLIC Boost::headers PRIVATE tomlplusplus::tomlplusplus)
#
# PUBLIC and PRIVATE as in target_link_libraries; INSIDE is for packages of headers that only sources include, which users
# of the installed library therefore do not need. The component is kinetic if not given; a room of a component that is
# not built (ApsisComponents.cmake) is skipped. C_INTERFACE names the header of a room with a C interface: always a shared
# library, with static rooms inside, the functions listed in its exported.map alone, and the ABI_VERSION of the header in its name.

add_library(apsis_options INTERFACE)
target_compile_features(apsis_options INTERFACE cxx_std_20)
# The same definition as in Boost::headers; a precompiled header requires it in all files or in no file.
target_compile_definitions(apsis_options INTERFACE BOOST_ALL_NO_LIB)
# Kernels are compiled for the plain architecture, 256 and 512 bit (exec/simd-inl.hpp); targets in between, or with
# instructions that no kernel uses, would only cost build time.
target_compile_definitions(apsis_options INTERFACE
  "HWY_DISABLED_TARGETS=(HWY_SSSE3|HWY_SSE4|HWY_AVX3_DL)")
target_compile_options(apsis_options INTERFACE
  -Wall -Wextra -Wshadow -Wconversion
  $<$<BOOL:${APSIS_WERROR}>:-Werror>
  -fno-math-errno
  # g++-12 reports overlaps in its own std::string (GCC bug 105651), and more of them with precompiled headers.
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>
  "$<$<AND:$<CXX_COMPILER_ID:GNU>,$<BOOL:${APSIS_PCH}>>:-Wno-array-bounds;-Wno-stringop-overflow;-Wno-stringop-overread>"
  # g++ collects garbage from 128 MB on, which takes up to a fifth of the time of large files.
  "$<$<AND:$<CXX_COMPILER_ID:GNU>,$<BOOL:${CMAKE_UNITY_BUILD}>>:SHELL:--param ggc-min-heapsize=1000000>"
  # Files that are compiled together look like headers to it, and shadow each other's functions.
  "$<$<AND:$<CXX_COMPILER_ID:GNU>,$<BOOL:${CMAKE_UNITY_BUILD}>>:-Wno-subobject-linkage;-Wno-shadow;-Wshadow=local>"
  "$<$<AND:$<CXX_COMPILER_ID:Clang>,$<BOOL:${CMAKE_UNITY_BUILD}>>:-Wno-shadow>")

# Tests and what only reads cases: -Og takes two thirds of the build time of -O1 with g++-12. A test of many methods runs
# for 1.4 times as long.
set(APSIS_QUICKLY_BUILT $<$<CONFIG:Release>:-Og>)
# The program and the Python module mostly call the rooms.
set(APSIS_CALLER $<$<CONFIG:Release>:-O1>)
# Rooms without loops over cells: -O3 costs build time without a speedup.
set(APSIS_PLAIN $<$<CONFIG:Release>:-O2>)

# Rooms with loops over cells and velocities. Their headers have no type whose layout depends on the instruction
# set, so other targets are built for the baseline architecture and link with them safely.
add_library(apsis_kernel_options INTERFACE)
target_compile_options(apsis_kernel_options INTERFACE
  -O3 -fopenmp-simd -fno-trapping-math
  # A number must be rounded equally in the middle and at the end of a row, which different loops process: fma only
  # where the source requests it.
  -ffp-contract=off
  # Sanitizers prevent clang from vectorising some loops; this must not be an error.
  $<$<CXX_COMPILER_ID:Clang>:-Wno-pass-failed>)

# Headers that most files include, at a cost of seconds each (see APSIS_PCH). Rooms with kernels have other flags and
# do not use them.
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

# Names and exports of a library with a C interface; `header` defines a version of the binary interface.
function(apsis_c_library name header)
  file(STRINGS ${header} version REGEX "^#define APSIS_[A-Z_]*ABI_VERSION [0-9]+$")
  string(REGEX MATCH "[0-9]+$" version "${version}")
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${header})
  set(map ${CMAKE_CURRENT_SOURCE_DIR}/${name}/exported.map)
  target_link_options(apsis_${name} PRIVATE LINKER:--version-script=${map})
  set_target_properties(apsis_${name} PROPERTIES LINK_DEPENDS ${map} INSTALL_RPATH "$ORIGIN"
                        VERSION ${version}.${PROJECT_VERSION} SOVERSION ${version})
endfunction()

function(apsis_room name)
  cmake_parse_arguments(ROOM "KERNELS" "COMPONENT;C_INTERFACE" "DEPENDS;PUBLIC;PRIVATE;INSIDE;GENERATED" ${ARGN})
  if(NOT ROOM_COMPONENT)
    set(ROOM_COMPONENT kinetic)
  endif()
  if(NOT ROOM_COMPONENT IN_LIST apsis_parts)
    return()
  endif()
  set_property(GLOBAL APPEND PROPERTY APSIS_ROOMS_${ROOM_COMPONENT} ${name})
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${name}/*.cpp
       ${CMAKE_CURRENT_SOURCE_DIR}/${name}/*/*.cpp)
  # Functions with two implementations.
  if(apsis_mpi)
    list(FILTER sources EXCLUDE REGEX "/without_mpi/")
  else()
    list(FILTER sources EXCLUDE REGEX "/with_mpi/")
  endif()
  # Highway compiles such a file several times, which must not include others.
  foreach(source IN LISTS sources)
    file(STRINGS ${source} several_targets REGEX "foreach_target" LIMIT_COUNT 1)
    if(several_targets)
      set_source_files_properties(${source} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
    endif()
  endforeach()
  set(kind "")
  set(to_users PUBLIC)
  if(ROOM_C_INTERFACE)
    set(kind SHARED)
    set(to_users PRIVATE)  # who do not read C++
  endif()
  add_library(apsis_${name} ${kind} ${sources} ${ROOM_GENERATED})
  add_library(apsis::${name} ALIAS apsis_${name})
  set_target_properties(apsis_${name} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON CXX_EXTENSIONS OFF
    # Exports of a room are not marked, so all symbols are visible, regardless of the settings of an enclosing project.
    CXX_VISIBILITY_PRESET default VISIBILITY_INLINES_HIDDEN OFF
    # Static and shared libraries have the same compile flags.
    DEFINE_SYMBOL "")
  get_target_property(type apsis_${name} TYPE)
  if(ROOM_C_INTERFACE)
    apsis_c_library(${name} ${CMAKE_CURRENT_SOURCE_DIR}/${ROOM_C_INTERFACE})
  elseif(type STREQUAL SHARED_LIBRARY)
    # Before 1.0 a minor version may change the interface.
    set_target_properties(apsis_${name} PROPERTIES INSTALL_RPATH "$ORIGIN" VERSION ${PROJECT_VERSION}
      SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
  endif()
  target_compile_features(apsis_${name} ${to_users} cxx_std_20)
  target_include_directories(apsis_${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/src> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  list(TRANSFORM ROOM_DEPENDS PREPEND apsis_)
  list(TRANSFORM ROOM_INSIDE REPLACE "(.+)" "$<BUILD_INTERFACE:\\1>")
  target_link_libraries(apsis_${name} ${to_users} ${ROOM_DEPENDS})
  target_link_libraries(apsis_${name} PUBLIC ${ROOM_PUBLIC})
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
