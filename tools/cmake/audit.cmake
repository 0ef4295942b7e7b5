# Optimised with assertions, to audit one run: cmake -C tools/cmake/audit.cmake -B build/audit
set(CMAKE_BUILD_TYPE Release CACHE STRING "")
set(CMAKE_CXX_FLAGS_RELEASE "-O3 -g -D_GLIBCXX_ASSERTIONS" CACHE STRING "")
