# Compile options shared by every target of the project: interface target hexhex_options.
add_library(hexhex_options INTERFACE)
target_compile_features(hexhex_options INTERFACE cxx_std_20)
target_compile_options(hexhex_options INTERFACE
  -Wall -Wextra -Wpedantic -Wconversion -Wshadow
  # The same doubles on every machine: no fused multiply-add where the source has none.
  -ffp-contract=off)
if(HEXHEX_WARNINGS_AS_ERRORS)
  target_compile_options(hexhex_options INTERFACE -Werror)
endif()

# HEXHEX_SANITIZE=address,undefined or thread: set by the presets.
set(HEXHEX_SANITIZE "" CACHE STRING "Sanitizers to build with, e.g. address,undefined")
if(HEXHEX_SANITIZE)
  target_compile_options(hexhex_options INTERFACE
    -fsanitize=${HEXHEX_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(hexhex_options INTERFACE -fsanitize=${HEXHEX_SANITIZE})
endif()

# One object library per folder of src/.
function(hexhex_folder name)
  add_library(hexhex_${name} OBJECT ${ARGN})
  target_include_directories(hexhex_${name} PUBLIC
    ${PROJECT_SOURCE_DIR}/include ${PROJECT_SOURCE_DIR}/src)
  target_link_libraries(hexhex_${name} PUBLIC hexhex_options hexhex_threads)
  # Only what a public header declares leaves the shared library.
  set_target_properties(hexhex_${name} PROPERTIES
    CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
endfunction()
