# Headers of Ipopt are found in the folder coin-or of newer versions and in coin.
#   cmake -DSOURCE=… -DWORK=… -P find_ipopt.cmake
include(${CMAKE_CURRENT_LIST_DIR}/support.cmake)
file(REMOVE_RECURSE ${WORK})
file(WRITE ${WORK}/project/CMakeLists.txt "cmake_minimum_required(VERSION 3.25)\nproject(found LANGUAGES NONE)
  list(APPEND CMAKE_MODULE_PATH ${SOURCE}/cmake)\nfind_package(Ipopt REQUIRED)
  get_target_property(headers Ipopt::Ipopt INTERFACE_INCLUDE_DIRECTORIES)\nmessage(STATUS \"headers in \${headers}.\")\n")
foreach(folder coin coin-or)
  file(WRITE ${WORK}/${folder}/include/${folder}/IpTNLP.hpp "")
  run(${CMAKE_COMMAND} -G Ninja -S ${WORK}/project -B ${WORK}/build-${folder} -DCMAKE_PREFIX_PATH=${WORK}/${folder}
      -DIPOPT_LIBRARY=${WORK}/libipopt.so)
  string(FIND "${output}" "headers in ${WORK}/${folder}/include/${folder}." at)
  if(at EQUAL -1)
    message(FATAL_ERROR "headers of ${folder} are not found:\n${output}")
  endif()
endforeach()
