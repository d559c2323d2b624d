# Headers, room libraries, the program and the package files, so that
#   find_package(apsis REQUIRED)  target_link_libraries(x PRIVATE apsis::apsis)
# works from another project. Warnings and -Werror stay here: apsis_options is not exported.
include(CMakePackageConfigHelpers)
set(apsis_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/apsis)

list(TRANSFORM APSIS_ROOMS PREPEND apsis_ OUTPUT_VARIABLE apsis_room_targets)
install(TARGETS apsis ${apsis_room_targets} EXPORT apsisTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/src/apsis DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
        FILES_MATCHING PATTERN "*.hpp")
install(EXPORT apsisTargets NAMESPACE apsis:: DESTINATION ${apsis_package_dir})

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/apsisConfig.cmake.in
  ${PROJECT_BINARY_DIR}/apsisConfig.cmake INSTALL_DESTINATION ${apsis_package_dir}
  NO_SET_AND_CHECK_MACRO)
# Before 1.0 a minor version may change the interface.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/apsisConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/apsisConfig.cmake ${PROJECT_BINARY_DIR}/apsisConfigVersion.cmake
        ${PROJECT_SOURCE_DIR}/cmake/FindIpopt.cmake
        DESTINATION ${apsis_package_dir})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/python/ DESTINATION ${CMAKE_INSTALL_DATADIR}/apsis FILES_MATCHING PATTERN "*.py")
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE ${PROJECT_SOURCE_DIR}/CITATION.cff
        DESTINATION ${CMAKE_INSTALL_DOCDIR})
