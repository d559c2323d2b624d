# Ipopt::Ipopt; Debian's Ipopt comes without a CMake package.
find_path(IPOPT_INCLUDE_DIR coin/IpTNLP.hpp)
find_library(IPOPT_LIBRARY ipopt)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Ipopt REQUIRED_VARS IPOPT_LIBRARY IPOPT_INCLUDE_DIR)
if(Ipopt_FOUND AND NOT TARGET Ipopt::Ipopt)
  add_library(Ipopt::Ipopt UNKNOWN IMPORTED)
  # Its headers require a definition that the standard headers exist.
  set_target_properties(Ipopt::Ipopt PROPERTIES
    IMPORTED_LOCATION ${IPOPT_LIBRARY}
    INTERFACE_INCLUDE_DIRECTORIES ${IPOPT_INCLUDE_DIR}/coin
    INTERFACE_COMPILE_DEFINITIONS HAVE_CSTDDEF)
endif()
