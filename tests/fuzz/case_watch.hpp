#pragma once
// Says which case crashed or hung.

#include <unistd.h>

#include <csignal>
#include <cstdint>
#include <cstdio>
#include <string>

namespace poreshock::test {

/// Handles crashes and alarms as long as it lives.
class CaseWatch {
 public:
  CaseWatch() { handle_all(tell); }
  ~CaseWatch() {
    end();
    handle_all(SIG_DFL);
  }
  CaseWatch(const CaseWatch&) = delete;
  CaseWatch& operator=(const CaseWatch&) = delete;

  /// A case has 20 seconds from here.
  void begin(std::uint64_t number) const {
    std::snprintf(current, sizeof(current), "case %llu ended the test\n",
                  static_cast<unsigned long long>(number));
    alarm(20);
  }
  void end() const { alarm(0); }

 private:
  static void handle_all(void (*handler)(int)) {
    for (const int number : {SIGSEGV, SIGABRT, SIGFPE, SIGALRM, SIGBUS}) {
      std::signal(number, handler);
    }
  }

  static void tell(int number) {
    const ssize_t written = write(STDERR_FILENO, current, std::char_traits<char>::length(current));
    std::signal(number, SIG_DFL);
    std::raise(written < 0 ? SIGABRT : number);
  }

  static inline char current[64] = "";  // a handler knows nothing else
};

}  // namespace poreshock::test
