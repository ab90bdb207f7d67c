#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# A scene on several processes of a Slurm cluster. Ten minutes before its time is over the run is interrupted and writes a
# checkpoint, and the job waits in the queue again to go on from it.
#   sbatch --ntasks=32 doc/cluster/job.sh SCENE.prm DIRECTORY
#SBATCH --job-name=exemplar
#SBATCH --ntasks=16
#SBATCH --cpus-per-task=1
#SBATCH --mem-per-cpu=4G
#SBATCH --time=12:00:00
#SBATCH --signal=B:USR1@600
#SBATCH --requeue
#SBATCH --open-mode=append
set -u
scene=${1:?"Usage: sbatch job.sh SCENE.prm DIRECTORY"}
directory=${2:?"Usage: sbatch job.sh SCENE.prm DIRECTORY"}
exemplar=${EXEMPLAR:-exemplar}   # or: apptainer exec exemplar.sif exemplar
export OMP_NUM_THREADS=1

resume=()
if [ -e "$directory/checkpoint.bin" ]; then resume=(--resume); fi

# mpirun takes the number of processes and the machines from Slurm
${MPIRUN:-mpirun} $exemplar "$scene" --output "$directory" --quiet "${resume[@]}" &
run=$!
trap 'kill -USR1 $run' USR1
trap 'kill -TERM $run' TERM
# a signal ends a wait, not the run
while :; do
  wait $run
  status=$?
  kill -0 $run 2>/dev/null || break
done
if [ $status -eq 130 ] && [ -n "${SLURM_JOB_ID:-}" ]; then
  scontrol requeue "$SLURM_JOB_ID"
fi
exit $status
