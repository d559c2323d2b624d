# Installs the build, for the tests that use the installed package.
include(${CMAKE_CURRENT_LIST_DIR}/support.cmake)
install_into(${BUILD} ${WORK}/prefix)
