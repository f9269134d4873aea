#!/usr/bin/env bash
# One task of an array of slurm-array.sh: runs its line of the list.
#   slurm-part.sh LIST LINES-BEFORE
set -euo pipefail
command=$(sed -n "$((SLURM_ARRAY_TASK_ID + $2))p" "$1")
[ -n "$command" ] || { echo "$1 has no line $((SLURM_ARRAY_TASK_ID + $2))" >&2; exit 2; }
eval "exec $command"
