# Installs the build into a fresh prefix, then configures, builds and runs a project that knows only the prefix.
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT status EQUAL 0)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "exit ${status}: ${command}\n${output}")
  endif()
endfunction()

file(REMOVE_RECURSE ${WORK})
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)

# Nothing of the build that made the package may reach a consumer.
file(GLOB_RECURSE exported ${WORK}/prefix/lib/*/apsisTargets*.cmake ${WORK}/prefix/lib/apsisTargets*.cmake)
if(NOT exported)
  message(FATAL_ERROR "no apsisTargets*.cmake below ${WORK}/prefix/lib")
endif()
foreach(file IN LISTS exported)
  file(READ ${file} text)
  foreach(leak "-march" "-Werror" "-Wall" "apsis_options" "${BUILD}")
    string(FIND "${text}" "${leak}" at)
    if(NOT at EQUAL -1)
      message(FATAL_ERROR "${file} leaks '${leak}' to consumers")
    endif()
  endforeach()
endforeach()

run(${CMAKE_COMMAND} -G Ninja -S ${CONSUMER} -B ${WORK}/build -DCMAKE_PREFIX_PATH=${WORK}/prefix
    -DCMAKE_CXX_COMPILER=${CXX} -DCMAKE_C_COMPILER=${CC} -DCMAKE_CXX_FLAGS=${FLAGS}
    -DCMAKE_BUILD_TYPE=${BUILD_TYPE})
run(${CMAKE_COMMAND} --build ${WORK}/build)
run(${WORK}/build/consumer)
