#!/usr/bin/env bash
# Estimates from all recordings of a list as a job array of Slurm. A job that its time limit ends is queued again, and
# --resume goes on. When the array is over, the results are merged:
#   sbatch slurm.sh LIST.csv RESULTS
#   scripts/run estimate --manifest LIST.csv --output RESULTS --merge TABLE.csv
# Slurm copies this file elsewhere, so submit it from the folder of the package.
#SBATCH --array=1-3
#SBATCH --cpus-per-task=1
#SBATCH --time=60
#SBATCH --signal=TERM@60
#SBATCH --requeue
set -euo pipefail
list=$1 results=$2
code=0
srun "${RUN:-scripts/run}" estimate --manifest "$list" --output "$results" --shard "$SLURM_ARRAY_TASK_ID/$SLURM_ARRAY_TASK_COUNT" \
  --threads "${SLURM_CPUS_PER_TASK:-1}" --resume --quiet || code=$?
if [ $code = 75 ]; then scontrol requeue "$SLURM_JOB_ID"; fi
exit $code
