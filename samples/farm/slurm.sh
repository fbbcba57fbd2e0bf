#!/bin/sh
# A Slurm job array of ssdo-filter. From the folder that holds the frames:
#
#   sbatch --array=1-100:10%8 slurm.sh 'shot.####.exr' 'lit.####.exr' --env sky.exr
#
# Each task filters as many frames as the array's step (here 10: 1-10, 11-20, ...), in one process; at most 8 run at a time. Run
# the same line again after a failure, a time limit or a scancel: frames that are done are left alone. A GPU, if there are any:
# --gres=gpu:1 before the script's name; Slurm then sets CUDA_VISIBLE_DEVICES and ssdo-filter takes that card.
#SBATCH --job-name=ssdo-filter
#SBATCH --cpus-per-task=2
#SBATCH --output=ssdo-filter.%A_%a.log
#SBATCH --open-mode=append
#SBATCH --requeue
set -eu
[ $# -ge 2 ] || { echo "usage: sbatch --array=FIRST-LAST[:STEP] $0 INPUT OUTPUT [OPTION...]" >&2; exit 2; }
input=$1 output=$2
shift 2
first=$SLURM_ARRAY_TASK_ID
last=$((first + ${SLURM_ARRAY_TASK_STEP:-1} - 1))
cpus=${SLURM_CPUS_PER_TASK:-2}
export LP_NUM_THREADS="$cpus" # Mesa's own threads, where there is no GPU

# exec, so that Slurm's SIGTERM reaches the program itself: it drops the frame it is at, cleans up and ends. The last chunk may
# reach beyond the shot, which --missing skip allows. Everything but the patterns and the frames must be the same in all tasks.
exec "${SSDO:-ssdo-filter}" "$input" -o "$output" --frames "$first-$last" --missing skip --skip-existing --keep-going \
    --threads "$cpus" --progress plain "$@"
