#!/usr/bin/env bash
# One run without a queue, on a machine that is already set up (tools/run also installs and builds):
#   nohup jobscripts/plain.sh RANKS SCENE OUTPUT [options of poreshock run] > run.log &
# kill PID (TERM), Ctrl-C or kill -USR1 end it with a checkpoint.
set -euo pipefail
cd "$(dirname "$0")/.."
source tools/stop_with_checkpoint.sh

usage="usage: jobscripts/plain.sh RANKS SCENE OUTPUT [options of poreshock run]"
run_with_checkpoint tools/mpirun -n "${1:?$usage}" build/release/poreshock run "${2:?$usage}" \
  --output "${3:?$usage}" "${@:4}"
