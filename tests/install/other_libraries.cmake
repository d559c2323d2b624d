# The component integrate alone, as shared libraries if the build has static ones, and vice versa: built
# without the packages of the other components, installed and consumed. It has the build type of subproject/, without
# flags, so that a compiler cache can reuse the objects.
include(${CMAKE_CURRENT_LIST_DIR}/support.cmake)
set(work ${WORK}/shared-${SHARED})
set(others "")
foreach(package HDF5 hwy Ipopt muparser nlohmann_json OpenMP Threads)
  list(APPEND others -DCMAKE_DISABLE_FIND_PACKAGE_${package}=TRUE)
endforeach()
configure(${SOURCE} ${work}/build -DBUILD_SHARED_LIBS=${SHARED} -DAPSIS_COMPONENTS=integrate -DAPSIS_TESTS=OFF
          -DCMAKE_BUILD_TYPE=Plain -DAPSIS_WERROR=OFF -DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER} -DCMAKE_UNITY_BUILD=ON ${others})
run(${CMAKE_COMMAND} --build ${work}/build)
install_into(${work}/build ${work}/prefix)

file(GLOB_RECURSE archives ${work}/prefix/libapsis_*.a ${work}/prefix/*/libapsis_*.a)
file(GLOB_RECURSE libraries ${work}/prefix/libapsis_*.so ${work}/prefix/*/libapsis_*.so)
list(LENGTH archives archives)
list(LENGTH libraries libraries)
if(SHARED)
  set(expected "0 4")  # core, method, integrate, verify
  set(packages fmt Boost)
else()
  set(expected "4 0")
  set(packages fmt Boost tomlplusplus)
endif()
if(NOT "${archives} ${libraries}" STREQUAL expected)
  message(FATAL_ERROR "${archives} static and ${libraries} shared libraries (expected: ${expected})")
endif()

consume(${CMAKE_CURRENT_LIST_DIR}/integrate ${work}/prefix ${work}/consumer "${packages}")
file(WRITE ${work}/refused/CMakeLists.txt
  "cmake_minimum_required(VERSION 3.25)\nproject(refused LANGUAGES CXX)\nfind_package(apsis REQUIRED COMPONENTS kinetic)\n")
configure_fails("component 'kinetic' is not installed (it was not built); valid: integrate"
                ${work}/refused ${work}/refused/build -DCMAKE_PREFIX_PATH=${work}/prefix)
