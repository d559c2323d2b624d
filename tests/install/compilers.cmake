# The choice of compilers: a preferred one where it is installed and nothing else chooses, otherwise that of CC and CXX, of
# CMAKE_CXX_COMPILER, or the default of CMake. A compiler without C++20 is refused with one message.
include(${CMAKE_CURRENT_LIST_DIR}/support.cmake)
set(work ${WORK}/compilers)
file(REMOVE_RECURSE ${work})
file(MAKE_DIRECTORY ${work}/bin)
foreach(name cc preferred-c)
  file(CREATE_LINK ${CC} ${work}/bin/${name} SYMBOLIC)
endforeach()
foreach(name c++ preferred-c++)
  file(CREATE_LINK ${CXX} ${work}/bin/${name} SYMBOLIC)
endforeach()
set(ENV{PATH} ${work}/bin:$ENV{PATH})
unset(ENV{CC})
unset(ENV{CXX})
unset(ENV{CMAKE_TOOLCHAIN_FILE})

# Configures with the arguments, and compares the file name of the C++ compiler.
function(compiler_is expected)
  file(REMOVE_RECURSE ${work}/build)
  run(${CMAKE_COMMAND} -G Ninja -B ${work}/build ${ARGN})
  file(STRINGS ${work}/build/CMakeCache.txt line REGEX "^CMAKE_CXX_COMPILER:")
  if(NOT line MATCHES "=${expected}$")
    message(FATAL_ERROR "expected the compiler ${expected}, got ${line} (${ARGN})")
  endif()
endfunction()

function(write_project)
  file(WRITE ${work}/project/CMakeLists.txt "cmake_minimum_required(VERSION 3.25)\nset(APSIS_PREFERRED_COMPILERS ${ARGN})\n"
    "include(${SOURCE}/cmake/ApsisCompiler.cmake)\nproject(chosen LANGUAGES C CXX)\n")
endfunction()
set(own ${work}/bin/c[+][+])
write_project()
compiler_is(${own} -S ${work}/project)
write_project(preferred-c missing-c++)
compiler_is(${own} -S ${work}/project)
write_project(preferred-c preferred-c++)
compiler_is(${work}/bin/preferred-c[+][+] -S ${work}/project)
compiler_is(${own} -S ${work}/project -DCMAKE_C_COMPILER=cc -DCMAKE_CXX_COMPILER=c++)

# The preset of `make run`.
set(part -DAPSIS_COMPONENTS=integrate -DAPSIS_APP=OFF -DAPSIS_TESTS=OFF)
compiler_is(${own} -S ${SOURCE} --preset release ${part} -DCMAKE_C_COMPILER=cc -DCMAKE_CXX_COMPILER=c++)
set(ENV{CC} cc)
set(ENV{CXX} c++)
compiler_is(${own} -S ${SOURCE} --preset release ${part})

# A compiler of C++17.
file(WRITE ${work}/bin/old-c++ "#!/bin/bash\nexec '${CXX}' \"\${@/-std=c++20/-std=c++17}\"\n")
file(CHMOD ${work}/bin/old-c++ PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE)
set(CXX ${work}/bin/old-c++)
configure_fails("(it does not compile a test of C++20, cmake/cxx20.cpp); select a compiler" ${SOURCE} ${work}/old ${part})
