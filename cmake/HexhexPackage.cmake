# Debian packages, one per component: `cpack --preset package`, or `cpack` in a build of the preset.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME hexhex)
set(CPACK_PACKAGE_VENDOR "The hexhex authors")
set(CPACK_PACKAGE_CONTACT "The hexhex authors <hexhex@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL library dev command)
if(HEXHEX_BUILD_PYTHON)
  list(APPEND CPACK_COMPONENTS_ALL python)
endif()
if(HEXHEX_HAS_MPI AND HEXHEX_BUILD_COMMAND)
  list(APPEND CPACK_COMPONENTS_ALL mpi)
  set(CPACK_DEBIAN_MPI_PACKAGE_NAME hexhex-mpi)
  set(CPACK_DEBIAN_MPI_PACKAGE_DEPENDS "hexhex (= ${PROJECT_VERSION})")
  set(CPACK_COMPONENT_MPI_DESCRIPTION "${PROJECT_DESCRIPTION} (the command on MPI)")
endif()
get_property(loaded_packages GLOBAL PROPERTY HEXHEX_LOADED_PACKAGES)
if("hexhex-highs" IN_LIST loaded_packages)
  list(APPEND CPACK_COMPONENTS_ALL highs)
  set(CPACK_DEBIAN_HIGHS_PACKAGE_NAME hexhex-highs)
  set(CPACK_DEBIAN_HIGHS_PACKAGE_SECTION libs)
  set(CPACK_COMPONENT_HIGHS_DESCRIPTION "HiGHS, which finds the integers of quantization for hexhex")
endif()
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
# What the programs need comes from what they are linked with; the shared library's own package
# declares itself.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${PROJECT_BINARY_DIR}/src)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS_POLICY ">=")

set(library libhexhex${PROJECT_VERSION_MAJOR})
set(exact "${library} (= ${PROJECT_VERSION})")

set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME ${library})
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libs)
set(CPACK_COMPONENT_LIBRARY_DESCRIPTION "${PROJECT_DESCRIPTION} (shared library)")

set(CPACK_DEBIAN_DEV_PACKAGE_NAME libhexhex-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEV_PACKAGE_SHLIBDEPS OFF)
# Who links the static library needs oneTBB.
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS "${exact}")
if(HEXHEX_HAS_TBB)
  string(APPEND CPACK_DEBIAN_DEV_PACKAGE_DEPENDS ", libtbb-dev")
endif()
get_property(component_libraries GLOBAL PROPERTY HEXHEX_COMPONENT_LIBRARIES)
foreach(pair IN ITEMS "hdf5=libhdf5-dev" "z[.]=zlib1g-dev")
  string(REPLACE "=" ";" pair ${pair})
  list(GET pair 0 name)
  list(GET pair 1 package)
  if("${component_libraries}" MATCHES "lib${name}")
    string(APPEND CPACK_DEBIAN_DEV_PACKAGE_DEPENDS ", ${package}")
  endif()
endforeach()
set(CPACK_DEBIAN_DEV_PACKAGE_SUGGESTS "libeigen3-dev, mpi-default-dev")
set(CPACK_COMPONENT_DEV_DESCRIPTION "${PROJECT_DESCRIPTION} (C++ and C headers, static library)")

set(CPACK_DEBIAN_COMMAND_PACKAGE_NAME hexhex)
set(CPACK_DEBIAN_COMMAND_PACKAGE_SUGGESTS xdg-utils)  # for `hexhex view --open`
# What is loaded only when a file or a quantization needs it.
if(loaded_packages)
  list(JOIN loaded_packages ", " loaded_packages)
  set(CPACK_DEBIAN_LIBRARY_PACKAGE_RECOMMENDS ${loaded_packages})
  set(CPACK_DEBIAN_COMMAND_PACKAGE_RECOMMENDS ${loaded_packages})
endif()
set(CPACK_COMPONENT_COMMAND_DESCRIPTION "${PROJECT_DESCRIPTION} (the command)")

set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-hexhex)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS python3-mpi4py)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
if(HEXHEX_BUILD_PYTHON)
  # The extension is made for one version of Python.
  find_package(Python 3.9 COMPONENTS Interpreter REQUIRED)
  math(EXPR next_minor "${Python_VERSION_MINOR} + 1")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "${exact}, python3-numpy, python3 (>= \
${Python_VERSION_MAJOR}.${Python_VERSION_MINOR}~), python3 (<< ${Python_VERSION_MAJOR}.${next_minor})")
endif()
set(CPACK_COMPONENT_PYTHON_DESCRIPTION "${PROJECT_DESCRIPTION} (Python 3)")

# What Debian wants to know of every package.
foreach(component IN LISTS CPACK_COMPONENTS_ALL)
  string(TOUPPER ${component} upper)
  install(FILES cmake/copyright COMPONENT ${component}
    DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${CPACK_DEBIAN_${upper}_PACKAGE_NAME})
endforeach()

include(CPack)
