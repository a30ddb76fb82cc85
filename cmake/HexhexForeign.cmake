# HEXHEX_FOREIGN: for compilers that cannot use the libraries of the system, as they make code for another one,
# or with another C++ library. Headers are taken from where Debian has them, and sources are compiled.
set(HEXHEX_HEADERS /usr/include CACHE PATH "Where CLI, fmt, nlohmann and boost are")
set(HEXHEX_GOOGLETEST /usr/src/googletest CACHE PATH "Sources of GoogleTest")

# Links, as the rest of the system's headers must not be seen.
set(headers ${PROJECT_BINARY_DIR}/headers)
foreach(name IN ITEMS CLI fmt nlohmann boost)
  if(NOT EXISTS ${HEXHEX_HEADERS}/${name})
    message(FATAL_ERROR "hexhex: ${HEXHEX_HEADERS}/${name} is missing. On Debian and Ubuntu:\n"
      "  sudo apt-get install libcli11-dev libfmt-dev nlohmann-json3-dev libboost-dev libgtest-dev")
  endif()
  file(MAKE_DIRECTORY ${headers})
  file(CREATE_LINK ${HEXHEX_HEADERS}/${name} ${headers}/${name} SYMBOLIC)
endforeach()

function(hexhex_foreign_headers target)
  add_library(${target} INTERFACE IMPORTED GLOBAL)
  target_include_directories(${target} SYSTEM INTERFACE ${ARGN})
endfunction()
hexhex_foreign_headers(CLI11::CLI11 ${headers})
hexhex_foreign_headers(nlohmann_json::nlohmann_json ${headers})
hexhex_foreign_headers(fmt::fmt ${headers})
target_compile_definitions(fmt::fmt INTERFACE FMT_HEADER_ONLY=1)
if(HEXHEX_BUILD_TESTS)
  set(INSTALL_GTEST OFF CACHE BOOL "")
  add_subdirectory(${HEXHEX_GOOGLETEST} googletest EXCLUDE_FROM_ALL)
  hexhex_foreign_headers(rapidcheck ${PROJECT_SOURCE_DIR}/tests/support/rapidcheck_stand_in ${headers})
endif()
foreach(name IN ITEMS CLI11 fmt nlohmann_json GTest rapidcheck Boost)
  set(${name}_FOUND TRUE)  # for hexhex_needs()
endforeach()
