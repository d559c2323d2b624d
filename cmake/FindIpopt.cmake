# Ipopt::Ipopt, which comes without a CMake package. IPOPT_INCLUDE_DIR contains a folder of its headers: coin-or since version 3.13,
# coin before, as in Debian 12.
find_path(IPOPT_INCLUDE_DIR NAMES coin-or/IpTNLP.hpp coin/IpTNLP.hpp)
find_library(IPOPT_LIBRARY ipopt)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Ipopt REQUIRED_VARS IPOPT_LIBRARY IPOPT_INCLUDE_DIR)
if(Ipopt_FOUND AND NOT TARGET Ipopt::Ipopt)
  add_library(Ipopt::Ipopt UNKNOWN IMPORTED)
  set(ipopt_headers ${IPOPT_INCLUDE_DIR}/coin)
  if(EXISTS ${IPOPT_INCLUDE_DIR}/coin-or/IpTNLP.hpp)
    set(ipopt_headers ${IPOPT_INCLUDE_DIR}/coin-or)
  endif()
  # Headers before 3.13 require a definition that the standard headers exist.
  set_target_properties(Ipopt::Ipopt PROPERTIES
    IMPORTED_LOCATION ${IPOPT_LIBRARY}
    INTERFACE_INCLUDE_DIRECTORIES ${ipopt_headers}
    INTERFACE_COMPILE_DEFINITIONS HAVE_CSTDDEF)
endif()
