# Consumes the installed package: CONSUMER is a folder, PACKAGES the packages that it may look for.
include(${CMAKE_CURRENT_LIST_DIR}/support.cmake)
separate_arguments(PACKAGES)
consume(${CMAKE_CURRENT_LIST_DIR}/${CONSUMER} ${WORK}/prefix ${WORK}/${CONSUMER} "${PACKAGES}")
