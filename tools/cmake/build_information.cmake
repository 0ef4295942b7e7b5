# What `poreshock --version` says of compiler, flags and libraries.
function(header_version header prefix parts result)
  set(version "")
  foreach(part IN LISTS parts)
    file(STRINGS ${header} line REGEX "define[ \t]+${prefix}${part}[ \t]+[0-9]+")
    string(REGEX MATCH "[0-9]+[ \t]*$" number "${line}")
    string(STRIP "${number}" number)
    list(APPEND version "${number}")
  endforeach()
  list(JOIN version "." version)
  set(${result} "${version}" PARENT_SCOPE)
endfunction()

header_version(${METIS_INCLUDE}/metis.h METIS_VER_ "MAJOR;MINOR;SUBMINOR" metis)
file(GLOB toml_headers ${TOMLPLUSPLUS_INCLUDE}/toml++/impl/version.hpp
                       ${TOMLPLUSPLUS_INCLUDE}/toml++/impl/version.h)
list(GET toml_headers 0 toml_header)
header_version(${toml_header} TOML_LIB_ "MAJOR;MINOR;PATCH" toml)

string(TOUPPER "${CMAKE_BUILD_TYPE}" kind)
get_target_property(options poreshock_flags INTERFACE_COMPILE_OPTIONS)
list(FILTER options EXCLUDE REGEX "^-W")
list(JOIN options " " options)
string(STRIP "${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${kind}} ${options}" flags)
string(REGEX REPLACE " +" " " flags "${flags}")
set_source_files_properties(src/app/build_information.cpp PROPERTIES COMPILE_DEFINITIONS
  "PORESHOCK_COMPILER=\"${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION}, ${CMAKE_BUILD_TYPE}\";PORESHOCK_FLAGS=\"${flags}\";PORESHOCK_HDF5=\"${HDF5_VERSION}\";PORESHOCK_METIS=\"${metis}\";PORESHOCK_TOML=\"${toml}\";PORESHOCK_CLI11=\"${CLI11_VERSION}\";PORESHOCK_PNG=\"${PNG_VERSION_STRING}\";PORESHOCK_TIFF=\"${TIFF_VERSION_STRING}\"")
