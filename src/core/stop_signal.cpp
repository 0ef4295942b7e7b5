#include "poreshock/core/stop_signal.hpp"

#include <csignal>
#include <initializer_list>

namespace poreshock {

namespace {
// A signal handler can reach nothing but an object of static storage.
volatile std::sig_atomic_t arrived = 0;
}  // namespace

void catch_stop_signals() {
  struct sigaction raise_flag {};
  raise_flag.sa_handler = [](int) { arrived = 1; };
  raise_flag.sa_flags = SA_RESTART;
  for (const int signal : {SIGTERM, SIGINT, SIGUSR1, SIGUSR2, SIGXCPU, SIGHUP}) {
    // nohup has a run ignore the end of its terminal: that stays so.
    struct sigaction before {};
    const bool known = sigaction(signal, nullptr, &before) == 0;
    if (signal == SIGHUP && known && before.sa_handler == SIG_IGN) continue;
    sigaction(signal, &raise_flag, nullptr);
  }
}

bool stop_signal_arrived() {
  return arrived != 0;
}

}  // namespace poreshock
