#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# One mesh over 4 nodes: sbatch simplify_one_mesh.sh IN.ply OUT.ply 0.1%
# A job that was killed goes on where it was when it is submitted again.
#SBATCH --job-name=meshbound
#SBATCH --nodes=4
#SBATCH --ntasks-per-node=4
#SBATCH --cpus-per-task=8
#SBATCH --mem=64G
#SBATCH --time=02:00:00
set -euo pipefail

in=$1 out=$2 tolerance=$3
scratch=${SCRATCH:-$PWD}/meshbound # on a file system that all nodes share

srun simplify_with_bound_mpi "$in" "$out" --tolerance "$tolerance" --threads "$SLURM_CPUS_PER_TASK" --memory 16G \
  --scratch "$scratch" --resume --json "${out%.*}.json"
