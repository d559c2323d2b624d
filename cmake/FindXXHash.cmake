# XXHASH_INCLUDE_DIR, the folder of xxhash.h; Debian's xxHash comes without a CMake package. The header alone is used
# (XXH_INLINE_ALL, in one .cpp), so there is nothing to link, and an installed Apsis does not look for it.
find_path(XXHASH_INCLUDE_DIR xxhash.h)
mark_as_advanced(XXHASH_INCLUDE_DIR)
if(XXHASH_INCLUDE_DIR)
  file(STRINGS ${XXHASH_INCLUDE_DIR}/xxhash.h lines REGEX "^#define XXH_VERSION_(MAJOR|MINOR|RELEASE) +[0-9]+")
  string(REGEX MATCHALL "[0-9]+" numbers "${lines}")
  list(JOIN numbers "." XXHASH_VERSION)
endif()
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(XXHash REQUIRED_VARS XXHASH_INCLUDE_DIR VERSION_VAR XXHASH_VERSION REASON_FAILURE_MESSAGE
  "files are sealed with XXH3: install libxxhash-dev or set XXHASH_INCLUDE_DIR to the folder of xxhash.h")
