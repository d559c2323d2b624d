# Headers, room libraries, the program and the package files, so that
#   find_package(apsis REQUIRED)  target_link_libraries(x PRIVATE apsis::apsis)
# works from another project. Warnings and -Werror stay here: apsis_options is not exported.
include(CMakePackageConfigHelpers)
set(apsis_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/apsis)

list(TRANSFORM APSIS_ROOMS PREPEND apsis_ OUTPUT_VARIABLE apsis_room_targets)
install(TARGETS apsis ${apsis_room_targets} EXPORT apsisTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
        COMPONENT development)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/src/apsis DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development
        FILES_MATCHING PATTERN "*.hpp")
install(EXPORT apsisTargets NAMESPACE apsis:: DESTINATION ${apsis_package_dir} COMPONENT development)

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/apsisConfig.cmake.in
  ${PROJECT_BINARY_DIR}/apsisConfig.cmake INSTALL_DESTINATION ${apsis_package_dir}
  NO_SET_AND_CHECK_MACRO)
# Before 1.0 a minor version may change the interface.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/apsisConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/apsisConfig.cmake ${PROJECT_BINARY_DIR}/apsisConfigVersion.cmake
        ${PROJECT_SOURCE_DIR}/cmake/FindIpopt.cmake
        DESTINATION ${apsis_package_dir} COMPONENT development)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE ${PROJECT_SOURCE_DIR}/CITATION.cff
        DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)

# Debian packages (cpack): apsis, the program, and libapsis-dev, for programs of one's own.
file(STRINGS ${PROJECT_SOURCE_DIR}/scripts/packages.txt run_lines REGEX "^run ")
string(REGEX MATCHALL "[a-z0-9+-]+-dev" development_packages "${run_lines}")
list(JOIN development_packages ", " development_packages)
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME apsis)
set(CPACK_PACKAGE_CONTACT "The Apsis maintainers")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL program development)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME apsis)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS "python3-matplotlib, python3-h5py")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libapsis-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "${development_packages}")
include(CPack)
