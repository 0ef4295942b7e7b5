#!/usr/bin/env bash
# One run under PBS. Submit from the top folder of poreshock, after tools/build:
#   qsub -v scene=SCENE,output=OUTPUT jobscripts/pbs.sh
# To go on after a stop: qsub -v scene=SCENE,output=OUTPUT,restart=latest jobscripts/pbs.sh
#PBS -N poreshock
#PBS -l select=2:ncpus=32:mpiprocs=32
#PBS -l walltime=12:00:00
set -euo pipefail
cd "${PBS_O_WORKDIR:-.}"
source tools/stop_with_checkpoint.sh

# PBS leaves only seconds between TERM and KILL: ask for the checkpoint two minutes before the
# walltime above (keep the two numbers together).
seconds=$((12 * 3600 - 120))
run_with_checkpoint timeout --preserve-status --foreground --signal=USR1 "$seconds" \
  tools/mpirun -n "$(wc -l <"$PBS_NODEFILE")" build/release/poreshock run \
  "${scene:?qsub -v scene=SCENE,output=OUTPUT}" --output "${output:?qsub -v scene=SCENE,output=OUTPUT}" \
  ${restart:+--restart "$restart"}
