include(${CMAKE_CURRENT_LIST_DIR}/HexhexLoadedLibrary.cmake)

# hexhex_hdf5(SOURCE...): adds formats over HDF5, the serial library, which is loaded when a file needs it
# or, if it cannot be, linked.
function(hexhex_hdf5)
  # FindHDF5 would add all that a static HDF5 may need, and take the one for MPI.
  find_path(HDF5_INCLUDE_DIR hdf5.h PATH_SUFFIXES hdf5/serial)
  find_library(HDF5_LIBRARY NAMES hdf5_serial hdf5)
  if(NOT HDF5_INCLUDE_DIR OR NOT HDF5_LIBRARY)
    return()
  endif()
  file(GLOB configurations ${HDF5_INCLUDE_DIR}/H5pubconf*.h)
  foreach(configuration IN LISTS configurations)
    file(STRINGS ${configuration} parallel REGEX "define H5_HAVE_PARALLEL 1")
    if(parallel)
      message(STATUS "hexhex: ${HDF5_LIBRARY} is for MPI, and not used; set HDF5_INCLUDE_DIR and "
        "HDF5_LIBRARY to those of a serial HDF5")
      return()
    endif()
  endforeach()
  if(NOT HEXHEX_LOAD_HDF5 OR HDF5_LIBRARY MATCHES "[.]a$")
    hexhex_component(HDF5 "${HDF5_INCLUDE_DIR}" "${HDF5_LIBRARY}" ${ARGN})
    return()
  endif()
  # Who has no such library is told of the package that this one is from.
  hexhex_loaded_library(${HDF5_LIBRARY} name file package)
  if(NOT package)
    set(package "HDF5")
  endif()
  hexhex_component(HDF5 "${HDF5_INCLUDE_DIR}" "" ${ARGN})
  set_source_files_properties(core/hdf5_library.cpp ${ARGN} PROPERTIES COMPILE_DEFINITIONS
    "HEXHEX_HDF5_NAME=\"${name}\";HEXHEX_HDF5_FILE=\"${file}\";HEXHEX_HDF5_PACKAGE=\"${package}\"")
endfunction()
