# A second compiler, with the flags of release.cmake: cmake -C tools/cmake/clang.cmake -B build/clang
include(${CMAKE_CURRENT_LIST_DIR}/release.cmake)
set(CMAKE_C_COMPILER clang-14 CACHE STRING "")
set(CMAKE_CXX_COMPILER clang++-14 CACHE STRING "")
