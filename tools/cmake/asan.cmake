# AddressSanitizer and UndefinedBehaviorSanitizer: cmake -C tools/cmake/asan.cmake -B build/asan
set(CMAKE_BUILD_TYPE RelWithDebInfo CACHE STRING "")
set(CMAKE_CXX_FLAGS_RELWITHDEBINFO
    "-O1 -g -fno-var-tracking -D_GLIBCXX_ASSERTIONS -fsanitize=address,undefined -fno-sanitize-recover=undefined -fno-omit-frame-pointer"
    CACHE STRING "")
set(PORESHOCK_PATIENCE 10 CACHE STRING "")
set(PORESHOCK_KEEP_PLUGINS ON CACHE BOOL "")
