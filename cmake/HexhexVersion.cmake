# Sets HEXHEX_VERSION to what include/hexhex/version.h says.
set(version_header ${CMAKE_CURRENT_LIST_DIR}/../include/hexhex/version.h)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${version_header})
file(STRINGS ${version_header} numbers REGEX "^#define HEXHEX_VERSION_(MAJOR|MINOR|PATCH) [0-9]+$")
list(TRANSFORM numbers REPLACE "^.* " "")
list(JOIN numbers "." HEXHEX_VERSION)
if(NOT HEXHEX_VERSION MATCHES "^[0-9]+[.][0-9]+[.][0-9]+$")
  message(FATAL_ERROR "No version was found in ${version_header}.")
endif()
