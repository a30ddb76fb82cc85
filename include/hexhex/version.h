/* The version stands here alone; CMake and pip read it from this file. Read by C and C++.

   Semantic Versioning: a change of the major version may change the source and the binary
   interface, and the shared library's name (SONAME) changes with it; minor versions add to both,
   patch versions change neither. */
#ifndef HEXHEX_VERSION_H
#define HEXHEX_VERSION_H

#define HEXHEX_VERSION_MAJOR 1
#define HEXHEX_VERSION_MINOR 0
#define HEXHEX_VERSION_PATCH 0

#define HEXHEX_TEXT_OF_VALUE(value) #value
#define HEXHEX_TEXT_OF(macro) HEXHEX_TEXT_OF_VALUE(macro)
/* The three as text: "major.minor.patch". */
#define HEXHEX_VERSION                 \
  HEXHEX_TEXT_OF(HEXHEX_VERSION_MAJOR) \
  "." HEXHEX_TEXT_OF(HEXHEX_VERSION_MINOR) "." HEXHEX_TEXT_OF(HEXHEX_VERSION_PATCH)

#endif
