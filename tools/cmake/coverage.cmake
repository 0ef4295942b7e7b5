# Counts which lines run: cmake -C tools/cmake/coverage.cmake -B build/coverage. Each rank counts on its own.
set(CMAKE_BUILD_TYPE Debug CACHE STRING "")
set(CMAKE_CXX_FLAGS_DEBUG "-O1 --coverage -fprofile-update=atomic" CACHE STRING "")
set(PORESHOCK_PATIENCE 5 CACHE STRING "")
