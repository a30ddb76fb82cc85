# Compile options shared by every target of the project: interface target hexhex_options.
add_library(hexhex_options INTERFACE)
target_compile_features(hexhex_options INTERFACE cxx_std_20)
# The same doubles on every machine: no fused multiply-add where the source has none.
if(MSVC)  # clang-cl
  target_compile_options(hexhex_options INTERFACE /W3 /utf-8 /bigobj /EHsc /clang:-ffp-contract=off)
else()
  target_compile_options(hexhex_options INTERFACE
    -Wall -Wextra -Wpedantic -Wconversion -Wshadow -ffp-contract=off)
  if(HEXHEX_WARNINGS_AS_ERRORS)
    target_compile_options(hexhex_options INTERFACE -Werror)
  endif()
endif()

# HEXHEX_SANITIZE=address,undefined or thread: set by the presets.
set(HEXHEX_SANITIZE "" CACHE STRING "Sanitizers to build with, e.g. address,undefined")
if(HEXHEX_SANITIZE)
  target_compile_options(hexhex_options INTERFACE
    -fsanitize=${HEXHEX_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(hexhex_options INTERFACE -fsanitize=${HEXHEX_SANITIZE})
  if(HEXHEX_SANITIZE MATCHES integer)
    # A copy with its hash in the name, as ccache does not know that compilers read it.
    set(wraps ${PROJECT_SOURCE_DIR}/tests/integer-ignorelist.txt)
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${wraps})
    file(SHA1 ${wraps} hash)
    file(COPY_FILE ${wraps} ${PROJECT_BINARY_DIR}/ignorelist-${hash}.txt ONLY_IF_DIFFERENT)
    target_compile_options(hexhex_options INTERFACE
      -fsanitize-ignorelist=${PROJECT_BINARY_DIR}/ignorelist-${hash}.txt)
  endif()
endif()

# hexhex_needs(WHAT PACKAGE=DEBIAN-PACKAGE...): finds packages of CMake; if any are missing, says which ones
# of Debian and Ubuntu bring them.
macro(hexhex_needs what)
  set(missing "")
  set(missing_packages "")
  foreach(pair IN ITEMS ${ARGN})
    string(REPLACE "=" ";" pair ${pair})
    list(GET pair 0 name)
    list(GET pair 1 package)
    if(NOT ${name}_FOUND)
      find_package(${name} QUIET)
    endif()
    if(NOT ${name}_FOUND)
      list(APPEND missing ${name})
      list(APPEND missing_packages ${package})
    endif()
  endforeach()
  if(missing)
    list(JOIN missing ", " missing)
    list(JOIN missing_packages " " missing_packages)
    # With a space in front, CMake leaves lines as they are.
    message(FATAL_ERROR "hexhex: ${what} needs ${missing}. On Debian and Ubuntu:\n"
      "  sudo apt-get install ${missing_packages}")
  endif()
endmacro()

# hexhex_folder(NAME FILE...): one object library per folder of src/, of all its sources but the named
# ones, which optional components add.
function(hexhex_folder name)
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} *.cpp)
  list(REMOVE_ITEM sources ${ARGN})
  add_library(hexhex_${name} OBJECT ${sources})
  target_include_directories(hexhex_${name} PUBLIC
    ${PROJECT_SOURCE_DIR}/include ${PROJECT_SOURCE_DIR}/src)
  target_link_libraries(hexhex_${name} PUBLIC hexhex_options hexhex_threads)
  # Only what a public header declares leaves the shared library.
  set_target_properties(hexhex_${name} PROPERTIES
    CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
endfunction()
