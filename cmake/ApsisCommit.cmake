# Writes OUTPUT, a C++ file with the commit of the repository SOURCE; leaves an unchanged file untouched.
#   cmake -D SOURCE=… -D OUTPUT=… -P ApsisCommit.cmake
set(commit unknown)
find_program(GIT git)
# A repository above SOURCE belongs to a project that contains these sources.
if(GIT AND EXISTS ${SOURCE}/.git)
  execute_process(COMMAND ${GIT} -C ${SOURCE} rev-parse --verify HEAD OUTPUT_VARIABLE head
                  OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
  if(failed EQUAL 0)
    set(commit ${head})
    execute_process(COMMAND ${GIT} -C ${SOURCE} --no-optional-locks status --porcelain --untracked-files=no
                    OUTPUT_VARIABLE changes ERROR_QUIET)
    if(changes)
      string(APPEND commit "-dirty")
    endif()
  endif()
endif()
file(CONFIGURE OUTPUT ${OUTPUT} @ONLY CONTENT [[#include <apsis/core/version.hpp>

const char* apsis::commit() {
  return "@commit@";
}
]])
