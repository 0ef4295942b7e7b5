#!/usr/bin/env bash
# A table of runs as a job array: each task takes every N-th run of it. Submit from the top folder of
# poreshock, after tools/build, again and again until all is done; what is done is not repeated:
#   sbatch --array=1-16 jobscripts/slurm_sweep.sh FILE
#SBATCH --job-name=poreshock-sweep
#SBATCH --ntasks=1
#SBATCH --time=12:00:00
set -euo pipefail
cd "${SLURM_SUBMIT_DIR:-.}"
file=${1:?usage: sbatch --array=1-N jobscripts/slurm_sweep.sh FILE}
exec tools/sweep "$file" --part "$SLURM_ARRAY_TASK_ID/$SLURM_ARRAY_TASK_COUNT"
