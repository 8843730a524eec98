#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# The distance of two meshes over 2 nodes: sbatch measure_two_meshes.sh A.ply B.ply 0.1%
# The exit code of the job is 0 within the tolerance, 1 beyond it, 3 where a limit came first.
#SBATCH --job-name=meshbound-distance
#SBATCH --nodes=2
#SBATCH --ntasks-per-node=8
#SBATCH --cpus-per-task=4
#SBATCH --mem=64G
#SBATCH --time=01:00:00
set -euo pipefail

srun hausdorff_distance_mpi "$1" "$2" --tolerance "$3" --threads "$SLURM_CPUS_PER_TASK" --memory 8G --json distance.json
