#pragma once
// Asking a run to end in good order from outside.

namespace poreshock {

/// Makes SIGTERM, SIGINT, SIGUSR1, SIGUSR2, SIGXCPU and SIGHUP (unless it is ignored) raise a flag
/// instead of ending the process. Call after the Runtime was made, which installs handlers of its
/// own. Not collective.
void catch_stop_signals();

/// True once one of the signals has arrived on this rank. Not collective.
bool stop_signal_arrived();

}  // namespace poreshock
