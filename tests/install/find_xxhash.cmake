# XXH3 requires xxHash 0.8: a header of this version is found, an older or missing one is an error, and the message names
# the package to install. Without the line in CMakeLists.txt a missing header would end the build, not the configuration.
#   cmake -DSOURCE=… -DWORK=… -P find_xxhash.cmake
file(READ ${SOURCE}/CMakeLists.txt lists)
string(REGEX MATCH "find_package\\(XXHash [^)]*REQUIRED\\)" request "${lists}")
if(NOT request)
  message(FATAL_ERROR "CMakeLists.txt does not look for XXHash")
endif()

file(REMOVE_RECURSE ${WORK})
file(WRITE ${WORK}/find.cmake "list(APPEND CMAKE_MODULE_PATH ${SOURCE}/cmake)\n${request}\nmessage(\"at \${XXHASH_INCLUDE_DIR}\")\n")

# A script has no default folders, so only FOLDER is searched.
function(expect folder accepted text)
  execute_process(COMMAND ${CMAKE_COMMAND} -DCMAKE_INCLUDE_PATH=${WORK}/${folder} -DCMAKE_FIND_USE_CMAKE_ENVIRONMENT_PATH=OFF
                  -DCMAKE_FIND_USE_SYSTEM_ENVIRONMENT_PATH=OFF -P ${WORK}/find.cmake
                  RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  string(REGEX REPLACE "[ \n]+" " " output "${output}")
  string(FIND "${output}" "${text}" at)
  if(at EQUAL -1 OR (accepted AND NOT status EQUAL 0) OR (NOT accepted AND status EQUAL 0))
    message(FATAL_ERROR "${folder}: exit ${status}, expected '${text}' in\n${output}")
  endif()
endfunction()

foreach(version 0.7.4 0.8.1)
  string(REGEX MATCHALL "[0-9]" part ${version})
  list(GET part 0 major)
  list(GET part 1 minor)
  list(GET part 2 release)
  file(WRITE ${WORK}/${version}/xxhash.h
       "#define XXH_VERSION_MAJOR    ${major}\n#define XXH_VERSION_MINOR    ${minor}\n#define XXH_VERSION_RELEASE  ${release}\n")
endforeach()
expect(none FALSE "install libxxhash-dev")
expect(0.7.4 FALSE "Found unsuitable version \"0.7.4\"")
expect(0.8.1 TRUE "at ${WORK}/0.8.1")
