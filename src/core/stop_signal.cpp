#include "poreshock/core/stop_signal.hpp"

#include <csignal>
#include <initializer_list>

namespace poreshock {

namespace {
// A signal handler can reach nothing but an object of static storage.
volatile std::sig_atomic_t arrived = 0;
}  // namespace

void catch_stop_signals() {
  for (const int signal : {SIGTERM, SIGINT, SIGUSR1}) {
    std::signal(signal, [](int) { arrived = 1; });
  }
}

bool stop_signal_arrived() {
  return arrived != 0;
}

}  // namespace poreshock
