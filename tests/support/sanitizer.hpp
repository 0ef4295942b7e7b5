#pragma once
// What tests of memory must know of the build.

namespace poreshock::test {

/// True where AddressSanitizer allocates: it keeps what is freed, to see who still uses it.
#ifdef __SANITIZE_ADDRESS__
inline constexpr bool allocator_of_the_sanitizer = true;
#else
inline constexpr bool allocator_of_the_sanitizer = false;
#endif

}  // namespace poreshock::test
