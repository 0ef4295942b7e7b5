// Preloaded into one rank: after the signal SIGRTMIN, memory of PORESHOCK_FAULT_BYTES or more at
// once is not to be had, so that the rank throws std::bad_alloc wherever it asks for it.
#include <csignal>
#include <cstdlib>
#include <new>

namespace {

volatile std::sig_atomic_t gone = 0;
std::size_t least = 0;

__attribute__((constructor)) void begin() {
  const char* bytes = std::getenv("PORESHOCK_FAULT_BYTES");
  least = bytes != nullptr ? std::strtoull(bytes, nullptr, 10) : 1;
  std::signal(SIGRTMIN, [](int) { gone = 1; });
}

}  // namespace

void* operator new(std::size_t bytes) {
  if (gone != 0 && bytes >= least) throw std::bad_alloc();
  if (void* memory = std::malloc(bytes > 0 ? bytes : 1)) return memory;
  throw std::bad_alloc();
}

void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
