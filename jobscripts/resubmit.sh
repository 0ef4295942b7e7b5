# shellcheck shell=bash
# Sourced by the Slurm scripts that submit themselves again.

# newest_checkpoint FOLDER: prints the path of the checkpoint with the highest step, if there is one.
newest_checkpoint() {
  [[ ! -d $1 ]] || find "$1" -maxdepth 1 -name 'checkpoint_*.h5' | sort | tail -n 1
}

# go_on_later FOLDER BEFORE OPTION... SCRIPT ARGUMENT...: submits a script again, with these options of
# sbatch and the tasks, time and partition of this job, unless this job came no further than the
# checkpoint BEFORE.
go_on_later() {
  local folder=$1 before=$2
  shift 2
  if [[ $(newest_checkpoint "$folder") == "$before" ]]; then
    echo "This job wrote no checkpoint, so the next one would not get further: give each job more time." >&2
    return 1
  fi
  # Options given to sbatch on the command line are not kept, so the important ones are passed on.
  sbatch --ntasks="$SLURM_NTASKS" --time="$(squeue --noheader --jobs="$SLURM_JOB_ID" --format=%l)" \
    --partition="$SLURM_JOB_PARTITION" "$@"
}
