#!/usr/bin/env bash
# A sweep as a job array: line N of the file SWEEP holds the options of run N, for example
#   --set loading.velocity=700 --set sample.seed=2
# and run N writes to OUTPUT/N. Each run submits itself again until it is done. Submit from the top
# folder of poreshock, after tools/build:
#   sbatch --array=1-$(wc -l <SWEEP) jobscripts/slurm_array.sh SCENE OUTPUT SWEEP
# The same command again goes on with the runs that have a checkpoint and leaves the others alone.
#SBATCH --job-name=poreshock-sweep
#SBATCH --ntasks=8
#SBATCH --time=12:00:00
# Two minutes before the end Slurm signals this script, which asks the ranks for a checkpoint.
#SBATCH --signal=B:USR1@120
set -euo pipefail
cd "${SLURM_SUBMIT_DIR:-.}"
source tools/stop_with_checkpoint.sh
source jobscripts/resubmit.sh

usage="usage: sbatch --array=1-N jobscripts/slurm_array.sh SCENE OUTPUT SWEEP"
scene=${1:?$usage}
folder=${2:?$usage}
sweep=${3:?$usage}
number=${SLURM_ARRAY_TASK_ID:?$usage}
output=$folder/$number
line=$(sed -n "${number}p" "$sweep")
read -r -a options <<<"$line"
[[ ${#options[@]} -gt 0 ]] || { echo "$sweep has no line $number." >&2; exit 2; }

before=$(newest_checkpoint "$output")
restart=()
[[ -z $before ]] || restart=(--restart latest)
if [[ -z $before && -e $output ]]; then
  echo "$output is there without a checkpoint: it is done, or has to be removed to be run again."
  exit 0
fi
mkdir -p "$folder"
run_with_checkpoint tools/mpirun -n "$SLURM_NTASKS" build/release/poreshock run "$scene" \
  --output "$output" ${restart[@]+"${restart[@]}"} "${options[@]}"

if [[ $stopped == 0 ]]; then
  echo "Run $number is done."
else
  go_on_later "$output" "$before" --array="$number" jobscripts/slurm_array.sh "$@"
fi
