# WebAssembly, by Debian's emscripten (preset `wasm`): single-threaded, as pages of files cannot ask
# browsers for threads. To be included before targets are made. docs/user/browser.md
#
# Headers of the system's packages work here, too, but not its libraries: zlib is compiled from the
# sources in an npm package.

set(CMAKE_POSITION_INDEPENDENT_CODE OFF)  # it would be slower, and is for dynamic linking
set(Eigen3_DIR /usr/share/eigen3/cmake CACHE PATH "")
set(nlohmann_json_DIR /usr/share/cmake/nlohmann_json CACHE PATH "")

option(HEXHEX_WASM_SIMD "Use WebAssembly's vector instructions" ON)
if(HEXHEX_WASM_SIMD)
  add_compile_options(-msimd128)
endif()
# Exceptions by the engine instead of by JavaScript, which takes time at every call.
add_compile_options(-fwasm-exceptions)
add_link_options(-fwasm-exceptions)
# Sizes have 32 bits here, as all that is in memory has fewer elements.
target_compile_options(hexhex_options INTERFACE -Wno-shorten-64-to-32 -Wno-sign-conversion)

# What the C++ library lacks. Of /usr/include, only these folders: the rest is of another machine.
set(headers ${PROJECT_BINARY_DIR}/headers)
file(MAKE_DIRECTORY ${headers})
foreach(library fmt fast_float nlohmann)
  if(NOT EXISTS /usr/include/${library})
    message(FATAL_ERROR "hexhex: the wasm build needs libfmt-dev, libfast-float-dev, nlohmann-json3-dev")
  endif()
  file(CREATE_LINK /usr/include/${library} ${headers}/${library} SYMBOLIC)
endforeach()
add_compile_options("$<$<COMPILE_LANGUAGE:CXX>:SHELL:-isystem ${headers}>"
  "$<$<COMPILE_LANGUAGE:CXX>:SHELL:-include ${PROJECT_SOURCE_DIR}/bindings/js/libcxx13.hpp>")

find_package(nlohmann_json REQUIRED)
set_target_properties(nlohmann_json::nlohmann_json PROPERTIES
  INTERFACE_INCLUDE_DIRECTORIES ${headers})

# Debian's emscripten looks for the packages of Debian's Node, whichever Node is installed.
set_property(GLOBAL PROPERTY RULE_LAUNCH_LINK
  "${CMAKE_COMMAND} -E env NODE_PATH=/usr/share/nodejs")

# The npm packages of bindings/js, zlib's sources among them.
find_program(HEXHEX_NPM npm NO_CMAKE_FIND_ROOT_PATH)
find_program(HEXHEX_NODE NAMES node nodejs NO_CMAKE_FIND_ROOT_PATH)
set(HEXHEX_JS_BUILD ${PROJECT_BINARY_DIR}/js)
set(lock ${PROJECT_SOURCE_DIR}/bindings/js/package-lock.json)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${lock})
file(SHA1 ${lock} hash)
if(NOT EXISTS ${HEXHEX_JS_BUILD}/${hash}.stamp)
  file(COPY ${lock} ${PROJECT_SOURCE_DIR}/bindings/js/package.json DESTINATION ${HEXHEX_JS_BUILD})
  execute_process(
    COMMAND ${HEXHEX_NPM} ci --ignore-scripts --no-audit --no-fund --loglevel=error
    WORKING_DIRECTORY ${HEXHEX_JS_BUILD}
    RESULT_VARIABLE status)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "hexhex: npm could not install the packages of bindings/js")
  endif()
  file(TOUCH ${HEXHEX_JS_BUILD}/${hash}.stamp)
endif()

set(zlib ${HEXHEX_JS_BUILD}/node_modules/zlib-sync/deps/zlib)
add_library(hexhex_zlib STATIC
  ${zlib}/adler32.c ${zlib}/compress.c ${zlib}/crc32.c ${zlib}/deflate.c ${zlib}/inffast.c
  ${zlib}/inflate.c ${zlib}/inftrees.c ${zlib}/trees.c ${zlib}/uncompr.c ${zlib}/zutil.c)
set_target_properties(hexhex_zlib PROPERTIES
  UNITY_BUILD OFF
  OUTPUT_NAME z ARCHIVE_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR})
target_compile_options(hexhex_zlib PRIVATE -w)  # not our code
set(ZLIB_INCLUDE_DIR ${zlib} CACHE PATH "")
set(ZLIB_LIBRARY ${PROJECT_BINARY_DIR}/libz.a CACHE FILEPATH "")
