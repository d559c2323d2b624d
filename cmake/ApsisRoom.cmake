# One static library per room of src/apsis. A room may link only the rooms below it, so an include
# that reaches back does not link and the direction of the data flow is kept by the build.
#
#   apsis_room(method DEPENDS core PUBLIC Boost::headers PRIVATE tomlplusplus::tomlplusplus HEAVY <string>)
#
# HEAVY headers are those that most of its files include and that take seconds to read (see APSIS_PCH).
set(APSIS_ROOMS "" CACHE INTERNAL "rooms in the order they are declared")

add_library(apsis_options INTERFACE)
target_compile_features(apsis_options INTERFACE cxx_std_20)
target_compile_options(apsis_options INTERFACE
  -Wall -Wextra -Wshadow -Wconversion
  $<$<BOOL:${APSIS_WERROR}>:-Werror>
  -fno-math-errno
  # g++-12 sees overlaps in its own std::string (GCC bug 105651), and more of them once headers are precompiled.
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>
  "$<$<AND:$<CXX_COMPILER_ID:GNU>,$<BOOL:${APSIS_PCH}>>:-Wno-array-bounds;-Wno-stringop-overflow;-Wno-stringop-overread>")

# What only calls the rooms (program, tests) gains nothing from optimisation but time to build.
set(APSIS_QUICKLY_BUILT $<$<CONFIG:Release>:-O1>)

# Rooms with loops over cells and velocities. Their headers keep no type whose layout depends on the instruction
# set, so other targets are built for the plain architecture and link with them safely.
add_library(apsis_kernel_options INTERFACE)
target_compile_options(apsis_kernel_options INTERFACE
  -O3 -fopenmp-simd -fno-trapping-math $<$<BOOL:${APSIS_NATIVE}>:-march=native>
  # Sanitizers keep clang from vectorising some loops; that is no reason to fail there.
  $<$<CXX_COMPILER_ID:Clang>:-Wno-pass-failed>)

function(apsis_room name)
  cmake_parse_arguments(ROOM "KERNELS" "" "DEPENDS;PUBLIC;PRIVATE;GENERATED;HEAVY" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${name}/*.cpp
       ${CMAKE_CURRENT_SOURCE_DIR}/${name}/*/*.cpp)
  add_library(apsis_${name} STATIC ${sources} ${ROOM_GENERATED})
  add_library(apsis::${name} ALIAS apsis_${name})
  set_target_properties(apsis_${name} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON)
  target_compile_features(apsis_${name} PUBLIC cxx_std_20)
  target_include_directories(apsis_${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/src> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  list(TRANSFORM ROOM_DEPENDS PREPEND apsis_)
  target_link_libraries(apsis_${name} PUBLIC ${ROOM_DEPENDS} ${ROOM_PUBLIC})
  target_link_libraries(apsis_${name} PRIVATE $<BUILD_INTERFACE:apsis_options> ${ROOM_PRIVATE}
                        $<$<BOOL:${ROOM_KERNELS}>:$<BUILD_INTERFACE:apsis_kernel_options>>)
  if(APSIS_PCH AND ROOM_HEAVY)
    target_precompile_headers(apsis_${name} PRIVATE ${ROOM_HEAVY})
  endif()
  set(APSIS_ROOMS ${APSIS_ROOMS} ${name} CACHE INTERNAL "")
endfunction()
