# shellcheck shell=bash
# Sourced by tools/run and the job scripts.

# run_with_checkpoint COMMAND [ARGUMENT...]: runs a command that becomes mpirun and returns its exit
# code. The first TERM, INT, HUP, XCPU, USR1 or USR2 that reaches this shell goes on to mpirun as one
# USR1: the ranks end the step, write a checkpoint and exit 0. (TERM or INT would make mpirun kill them.)
# `stopped` is 1 afterwards if that happened, else 0.
run_with_checkpoint() {
  local status=0 pid
  stopped=0
  setsid "$@" </dev/null &  # its own session, or Ctrl-C would reach mpirun directly
  pid=$!
  trap 'stopped=1; trap "" TERM INT HUP XCPU USR1 USR2
        echo "Stopping: waiting for the checkpoint." >&2
        kill -USR1 '"$pid"' 2>/dev/null || true' TERM INT HUP XCPU USR1 USR2
  wait "$pid" || status=$?
  if [[ $stopped == 1 ]]; then  # the signal ended the first wait
    status=0
    wait "$pid" || status=$?
  fi
  trap - TERM INT HUP XCPU USR1 USR2
  return "$status"
}
