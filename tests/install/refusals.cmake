# Unavailable components: an error with the reason if required, not found if optional.
include(${CMAKE_CURRENT_LIST_DIR}/support.cmake)
function(write_project call more)
  file(WRITE ${WORK}/refused/CMakeLists.txt
    "cmake_minimum_required(VERSION 3.25)\nproject(refused LANGUAGES CXX)\n${call}\n${more}\n")
  file(REMOVE_RECURSE ${WORK}/refused/build)
endfunction()

write_project("find_package(apsis REQUIRED COMPONENTS kinetics)" "")
configure_fails("unknown component 'kinetics' (there is no such component); valid: integrate, kinetic, design, c, sundials, petsc"
                ${WORK}/refused ${WORK}/refused/build -DCMAKE_PREFIX_PATH=${WORK}/prefix)

write_project("find_package(apsis REQUIRED COMPONENTS kinetic)" "")
configure_fails("component 'kinetic' needs muparser (which was not found); install it"
                ${WORK}/refused ${WORK}/refused/build -DCMAKE_PREFIX_PATH=${WORK}/prefix -DCMAKE_DISABLE_FIND_PACKAGE_muparser=TRUE)

write_project("find_package(apsis REQUIRED COMPONENTS integrate OPTIONAL_COMPONENTS kinetic games)"
  "if(NOT apsis_FOUND OR NOT apsis_integrate_FOUND OR apsis_kinetic_FOUND OR apsis_games_FOUND OR TARGET apsis::kinetic)
     message(FATAL_ERROR \"integrate alone is to be found\")
   endif()
   find_package(apsis QUIET COMPONENTS games)
   if(apsis_FOUND)
     message(FATAL_ERROR \"there are no games\")
   endif()")
configure(${WORK}/refused ${WORK}/refused/build -DCMAKE_PREFIX_PATH=${WORK}/prefix
          -DCMAKE_DISABLE_FIND_PACKAGE_muparser=TRUE)

# After several calls apsis::apsis contains all components that were found.
write_project("find_package(apsis REQUIRED COMPONENTS integrate)\nfind_package(apsis REQUIRED COMPONENTS kinetic)"
  "get_target_property(all apsis::apsis INTERFACE_LINK_LIBRARIES)
   if(NOT all STREQUAL \"apsis::integrate;apsis::verify;apsis::kinetic\")
     message(FATAL_ERROR \"apsis::apsis links \${all}\")
   endif()")
configure(${WORK}/refused ${WORK}/refused/build -DCMAKE_PREFIX_PATH=${WORK}/prefix)
