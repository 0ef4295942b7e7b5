#!/usr/bin/env bash
# One run under Slurm. Submit from the top folder of poreshock, after tools/build:
#   sbatch jobscripts/slurm.sh SCENE OUTPUT [options of poreshock run]
#SBATCH --job-name=poreshock
#SBATCH --ntasks=64
#SBATCH --time=12:00:00
# Two minutes before the end Slurm signals this script, which asks the ranks for a checkpoint.
#SBATCH --signal=B:USR1@120
set -euo pipefail
cd "${SLURM_SUBMIT_DIR:-.}"
source tools/stop_with_checkpoint.sh

scene=${1:?usage: sbatch jobscripts/slurm.sh SCENE OUTPUT [options of poreshock run]}
output=${2:?usage: sbatch jobscripts/slurm.sh SCENE OUTPUT [options of poreshock run]}
run_with_checkpoint tools/mpirun -n "$SLURM_NTASKS" build/release/poreshock run "$scene" \
  --output "$output" "${@:3}"
