# Functions of the scripts of this folder.

# Runs a command and stores its output in `output`; the test ends if the command fails.
macro(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT status EQUAL 0)
    set(command ${ARGN})
    list(JOIN command " " command)
    message(FATAL_ERROR "exit ${status}: ${command}\n${output}")
  endif()
endmacro()

# Configures an external project with the compilers and flags of this build: configure(SOURCE BINARY more…).
macro(configure source binary)
  run(${CMAKE_COMMAND} -G Ninja -S ${source} -B ${binary} -DCMAKE_CXX_COMPILER=${CXX} -DCMAKE_C_COMPILER=${CC}
      -DCMAKE_CXX_FLAGS=${FLAGS} ${ARGN})
endmacro()

# Configures a project that must fail with a message that contains `expected`.
function(configure_fails expected source binary)
  execute_process(COMMAND ${CMAKE_COMMAND} -G Ninja -S ${source} -B ${binary} -DCMAKE_CXX_COMPILER=${CXX}
    -DCMAKE_C_COMPILER=${CC} ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  string(REGEX REPLACE "[ \n]+" " " output "${output}")  # cmake breaks lines
  string(FIND "${output}" "${expected}" at)
  if(status EQUAL 0 OR at EQUAL -1)
    message(FATAL_ERROR "expected a failure with '${expected}', got exit ${status}:\n${output}")
  endif()
endfunction()

# Installs the build into a fresh prefix, and checks that the installed files do not contain build paths.
function(install_into build prefix)
  file(REMOVE_RECURSE ${prefix} ${prefix}-first)
  run(${CMAKE_COMMAND} --install ${build} --prefix ${prefix}-first)
  file(RENAME ${prefix}-first ${prefix})
  file(GLOB_RECURSE files ${prefix}/lib*/*.cmake)
  if(NOT files MATCHES "apsisTargets-integrate\\.cmake")
    message(FATAL_ERROR "no apsisTargets-integrate.cmake below ${prefix}")
  endif()
  foreach(file IN LISTS files)
    file(READ ${file} text)
    foreach(leak "-march" "-Werror" "-Wall" "apsis_options" "${build}" "${SOURCE}" "${prefix}" "/usr/" "/lib/x86" "/home/")
      string(FIND "${text}" "${leak}" at)
      if(NOT at EQUAL -1)
        message(FATAL_ERROR "${file} leaks '${leak}' to consumers")
      endif()
    endforeach()
  endforeach()
endfunction()

# Configures the consumer against the prefix, checks that the package looked for exactly `packages`, builds and runs the
# consumer.
function(consume consumer prefix work packages)
  file(REMOVE_RECURSE ${work})
  # All other packages are disabled.
  set(others Boost Eigen3 fmt HDF5 hwy Ipopt muparser nlohmann_json OpenMP spdlog Threads tomlplusplus)
  if(packages)
    list(REMOVE_ITEM others ${packages})
  endif()
  list(TRANSFORM others REPLACE "(.+)" "-DCMAKE_DISABLE_FIND_PACKAGE_\\1=TRUE")
  configure(${consumer} ${work} -DCMAKE_PREFIX_PATH=${prefix} -DCMAKE_BUILD_TYPE=${BUILD_TYPE} --trace-expand
            --trace-redirect=${work}.trace ${others})
  file(STRINGS ${work}.trace calls REGEX "/apsisConfig\\.cmake\\([0-9]+\\): +find_package\\(")
  list(TRANSFORM calls REPLACE ".*find_package\\(([A-Za-z0-9_]+).*" "\\1")
  list(REMOVE_DUPLICATES calls)
  if(packages OR calls)
    list(SORT calls)
    list(SORT packages)
  endif()
  if(NOT calls STREQUAL packages)
    message(FATAL_ERROR "the package looked for '${calls}' (expected: '${packages}')")
  endif()
  run(${CMAKE_COMMAND} --build ${work})
  run(${work}/consumer)
endfunction()
