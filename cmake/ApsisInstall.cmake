# Headers, room libraries, the program and the package files, so that
#   find_package(apsis REQUIRED)  target_link_libraries(x PRIVATE apsis::apsis)
# works from another project. Warnings and -Werror stay here: apsis_options is not exported.
include(CMakePackageConfigHelpers)
set(apsis_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/apsis)

# The targets of each component have a separate file, which apsisConfig.cmake reads if the component is requested.
set(apsis_package_lists "")
foreach(part IN LISTS apsis_parts)
  get_property(rooms GLOBAL PROPERTY APSIS_ROOMS_${part})
  list(TRANSFORM rooms PREPEND apsis_ OUTPUT_VARIABLE targets)
  if(part STREQUAL kinetic)
    list(APPEND targets apsis_kinetic)
  endif()
  set(libraries program)
  if(part IN_LIST apsis_c_components)
    set(libraries ${part}_library)
  endif()
  install(TARGETS ${targets} EXPORT apsisTargets-${part}
          ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development
          LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT ${libraries} NAMELINK_COMPONENT development)
  install(EXPORT apsisTargets-${part} NAMESPACE apsis:: DESTINATION ${apsis_package_dir} COMPONENT development)
  if(part STREQUAL c)
    install(FILES ${PROJECT_SOURCE_DIR}/src/apsis/apsis.h ${PROJECT_SOURCE_DIR}/src/apsis/apsis.f90
            DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/apsis COMPONENT development)
    # The prefix is relative, so that an installation may move.
    file(RELATIVE_PATH apsis_prefix_of_pc /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
    configure_file(${PROJECT_SOURCE_DIR}/cmake/apsis_c.pc.in ${PROJECT_BINARY_DIR}/apsis_c.pc @ONLY)
    install(FILES ${PROJECT_BINARY_DIR}/apsis_c.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)
  elseif(part IN_LIST apsis_c_components)
    install(FILES ${PROJECT_SOURCE_DIR}/src/apsis/apsis_${part}.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/apsis
            COMPONENT development)
  endif()
  if(part IN_LIST apsis_c_components)
    set(rooms "")  # its other headers are internal
  endif()
  foreach(room IN LISTS rooms)
    install(DIRECTORY ${PROJECT_SOURCE_DIR}/src/apsis/${room} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/apsis
            COMPONENT development FILES_MATCHING PATTERN "*.hpp" PATTERN internal EXCLUDE)
  endforeach()

  set(packages ${apsis_packages_${part}})
  if(NOT BUILD_SHARED_LIBS)
    list(APPEND packages ${apsis_link_packages_${part}})
  endif()
  list(TRANSFORM packages REPLACE "(.+)" "\"\\1\"")
  list(JOIN packages " " packages)
  string(APPEND apsis_package_lists "set(apsis_packages_${part} ${packages})\n")
endforeach()

set(apsis_needed_by_c "")
if(BUILD_SHARED_LIBS)
  set(apsis_needed_by_c integrate) # whose libraries it loads
endif()
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/apsisConfig.cmake.in
  ${PROJECT_BINARY_DIR}/apsisConfig.cmake INSTALL_DESTINATION ${apsis_package_dir}
  NO_SET_AND_CHECK_MACRO)
# Before 1.0 a minor version may change the interface.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/apsisConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/apsisConfig.cmake ${PROJECT_BINARY_DIR}/apsisConfigVersion.cmake
        DESTINATION ${apsis_package_dir} COMPONENT development)
foreach(part package IN ZIP_LISTS apsis_framework_components apsis_framework_packages)
  if(part IN_LIST apsis_parts)
    install(FILES ${PROJECT_SOURCE_DIR}/cmake/Find${package}.cmake DESTINATION ${apsis_package_dir} COMPONENT development)
  endif()
endforeach()
if("design" IN_LIST apsis_parts AND NOT BUILD_SHARED_LIBS)
  install(FILES ${PROJECT_SOURCE_DIR}/cmake/FindIpopt.cmake DESTINATION ${apsis_package_dir} COMPONENT development)
endif()
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE ${PROJECT_SOURCE_DIR}/CITATION.cff
        DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)

if(NOT PROJECT_IS_TOP_LEVEL)
  return()
endif()
# Debian packages (cpack): apsis, the program; libapsis-dev, for programs that use the library; and libapsis-cN with the
# library of the C interface, which such programs need to run; libapsis-sundialsN and libapsis-petscN for frameworks.
file(STRINGS ${PROJECT_SOURCE_DIR}/scripts/packages.txt run_lines REGEX "^run ")
string(REGEX MATCHALL "[a-z0-9+-]+-dev" development_packages "${run_lines}")
if(NOT "design" IN_LIST apsis_parts)
  list(REMOVE_ITEM development_packages coinor-libipopt-dev)
endif()
list(JOIN development_packages ", " development_packages)
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME apsis)
set(CPACK_PACKAGE_CONTACT "The Apsis maintainers")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL program development)
if(TARGET apsis_c)
  get_target_property(abi apsis_c SOVERSION)
  list(APPEND CPACK_COMPONENTS_ALL c_library)
  set(CPACK_DEBIAN_C_LIBRARY_PACKAGE_NAME libapsis-c${abi})
  set(CPACK_DEBIAN_C_LIBRARY_PACKAGE_SECTION libs)
  set(CPACK_DEBIAN_C_LIBRARY_PACKAGE_SHLIBDEPS ON)
  string(APPEND development_packages ", libapsis-c${abi} (= ${PROJECT_VERSION})")
endif()
# With their frameworks, which other users of the library do not need.
set(suggested "")
foreach(part IN LISTS apsis_framework_components)
  if(TARGET apsis_${part})
    get_target_property(abi apsis_${part} SOVERSION)
    list(APPEND CPACK_COMPONENTS_ALL ${part}_library)
    string(TOUPPER ${part} upper)
    set(CPACK_DEBIAN_${upper}_LIBRARY_PACKAGE_NAME libapsis-${part}${abi})
    set(CPACK_DEBIAN_${upper}_LIBRARY_PACKAGE_SECTION libs)
    set(CPACK_DEBIAN_${upper}_LIBRARY_PACKAGE_SHLIBDEPS ON)
    list(APPEND suggested "libapsis-${part}${abi} (= ${PROJECT_VERSION})" ${apsis_debian_package_${part}})
  endif()
endforeach()
if(TARGET apsis_sundials)
  # Whose library it loads.
  set(CPACK_DEBIAN_SUNDIALS_LIBRARY_PACKAGE_DEPENDS "${CPACK_DEBIAN_C_LIBRARY_PACKAGE_NAME} (= ${PROJECT_VERSION})")
  set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${PROJECT_BINARY_DIR}/src/apsis)
endif()
list(JOIN suggested ", " CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SUGGESTS)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME apsis)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS "python3-matplotlib, python3-h5py")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libapsis-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "${development_packages}")
include(CPack)
