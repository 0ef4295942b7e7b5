#!/usr/bin/env bash
# A run longer than one job: submits itself again with --restart latest until the run is done.
# Submit from the top folder of poreshock, after tools/build:
#   sbatch jobscripts/slurm_chain.sh SCENE OUTPUT [options of poreshock run]
#SBATCH --job-name=poreshock
#SBATCH --ntasks=64
#SBATCH --time=12:00:00
# Two minutes before the end Slurm signals this script, which asks the ranks for a checkpoint.
#SBATCH --signal=B:USR1@120
set -euo pipefail
cd "${SLURM_SUBMIT_DIR:-.}"
source tools/stop_with_checkpoint.sh
source jobscripts/resubmit.sh

scene=${1:?usage: sbatch jobscripts/slurm_chain.sh SCENE OUTPUT [options of poreshock run]}
output=${2:?usage: sbatch jobscripts/slurm_chain.sh SCENE OUTPUT [options of poreshock run]}

before=$(newest_checkpoint "$output")
restart=()
[[ -z $before ]] || restart=(--restart latest)
run_with_checkpoint tools/mpirun -n "$SLURM_NTASKS" build/release/poreshock run "$scene" \
  --output "$output" ${restart[@]+"${restart[@]}"} "${@:3}"

if [[ $stopped == 0 ]]; then
  echo "The run is done."
else
  go_on_later "$output" "$before" jobscripts/slurm_chain.sh "$@"
fi
