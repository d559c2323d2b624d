# These lists are generated from the existing files, because lists that exist twice drift apart.

# apsis_embed(methods ${root} toml out): a .cpp with the text of every *.toml below root, as the function
# apsis::embedded::methods() (see core/embedded.hpp).
function(apsis_embed symbol root ending out_var)
  file(GLOB_RECURSE files CONFIGURE_DEPENDS ${root}/*.${ending})
  list(SORT files)
  set(out ${CMAKE_CURRENT_BINARY_DIR}/generated/${symbol}.cpp)
  set(body "")
  foreach(file IN LISTS files)
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
    file(READ ${file} text)
    file(RELATIVE_PATH key ${root} ${file})
    string(REGEX REPLACE "\\.${ending}$" "" key ${key})
    string(APPEND body "    {\"${key}\", R\"apsis_text(${text})apsis_text\"},\n")
  endforeach()
  file(CONFIGURE OUTPUT ${out} @ONLY CONTENT
"// Generated from the ${ending} files of the project; do not edit.
#include <apsis/core/embedded.hpp>

namespace apsis::embedded {
std::vector<embedded_text> ${symbol}() {
  return {
@body@  };
}
}  // namespace apsis::embedded
")
  set(${out_var} ${out} PARENT_SCOPE)
endfunction()

# apsis_registry(what header folder out [namespace]): every file x.cpp of the folder defines `<what>_entry <what>_x`; the
# generated registry, which defines `<what>_entries()` of the header, is the only place that lists them all. The default
# namespace is apsis.
function(apsis_registry what header folder out_var)
  set(namespace apsis)
  if(ARGC GREATER 4)
    set(namespace ${ARGV4})
  endif()
  file(GLOB files CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${folder}/*.cpp)
  list(SORT files)
  # They have the same names inside, such as that of the function that makes an entry.
  set_source_files_properties(${files} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  set(declarations "")
  set(entries "")
  foreach(file IN LISTS files)
    get_filename_component(stem ${file} NAME_WE)
    string(APPEND declarations "extern const ${what}_entry ${what}_${stem};\n")
    string(APPEND entries "      &${what}_${stem},\n")
  endforeach()
  set(out ${CMAKE_CURRENT_BINARY_DIR}/generated/${what}_registry.cpp)
  file(CONFIGURE OUTPUT ${out} @ONLY CONTENT
"// Generated from the files of ${folder}/; do not edit.
#include <${header}>

namespace @namespace@ {
@declarations@
std::vector<const ${what}_entry*> ${what}_entries() {
  return {
@entries@  };
}
}  // namespace @namespace@
")
  set(${out_var} ${out} PARENT_SCOPE)
endfunction()
