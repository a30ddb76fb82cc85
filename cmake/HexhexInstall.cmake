# What `cmake --install` puts where, in the components library, dev and command.
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/hexhex)
foreach(kind IN ITEMS shared static)
  if(NOT TARGET hexhex_${kind})
    continue()
  endif()
  install(TARGETS hexhex_${kind} EXPORT hexhex-${kind}
    RUNTIME COMPONENT library
    LIBRARY COMPONENT library NAMELINK_COMPONENT dev
    ARCHIVE COMPONENT dev)
  install(EXPORT hexhex-${kind} NAMESPACE hexhex:: DESTINATION ${package_dir}
    FILE hexhex-${kind}.cmake COMPONENT dev)
endforeach()

set(no_headers PATTERN "view.hpp" EXCLUDE)  # of the command; no installed library has it
if(HEXHEX_HAS_MPI)
  install(TARGETS hexhex_mpi ARCHIVE COMPONENT dev)
else()
  list(APPEND no_headers PATTERN "mpi.hpp" EXCLUDE)
endif()
install(DIRECTORY include/hexhex
  DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT dev
  FILES_MATCHING PATTERN "*.hpp" PATTERN "*.h"
  ${no_headers})
install(FILES bindings/c/include/hexhex.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT dev)

configure_package_config_file(cmake/hexhexConfig.cmake.in ${PROJECT_BINARY_DIR}/hexhexConfig.cmake
  INSTALL_DESTINATION ${package_dir}
  PATH_VARS CMAKE_INSTALL_LIBDIR)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/hexhexConfigVersion.cmake
  COMPATIBILITY SameMajorVersion)
install(FILES
  ${PROJECT_BINARY_DIR}/hexhexConfig.cmake
  ${PROJECT_BINARY_DIR}/hexhexConfigVersion.cmake
  DESTINATION ${package_dir} COMPONENT dev)

# pkg-config finds the prefix from the file's own place, so that the package can be moved.
cmake_path(RELATIVE_PATH CMAKE_INSTALL_FULL_LIBDIR BASE_DIRECTORY ${CMAKE_INSTALL_PREFIX}
  OUTPUT_VARIABLE libdir)
cmake_path(RELATIVE_PATH CMAKE_INSTALL_FULL_INCLUDEDIR BASE_DIRECTORY ${CMAKE_INSTALL_PREFIX}
  OUTPUT_VARIABLE includedir)
file(RELATIVE_PATH up ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
string(REGEX REPLACE "/$" "" up "${up}")
set(HEXHEX_PC_PREFIX "\${pcfiledir}/${up}")
set(HEXHEX_PC_LIBDIR "\${prefix}/${libdir}")
set(HEXHEX_PC_INCLUDEDIR "\${prefix}/${includedir}")
set(HEXHEX_PC_LIBS_PRIVATE "-lstdc++ -lm -pthread")
if(HEXHEX_HAS_TBB)
  string(PREPEND HEXHEX_PC_LIBS_PRIVATE "-ltbb ")
endif()
get_property(component_libraries GLOBAL PROPERTY HEXHEX_COMPONENT_LIBRARIES)
foreach(library IN LISTS component_libraries)
  string(PREPEND HEXHEX_PC_LIBS_PRIVATE "${library} ")
endforeach()
configure_file(cmake/hexhex.pc.in ${PROJECT_BINARY_DIR}/hexhex.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/hexhex.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig
  COMPONENT dev)
