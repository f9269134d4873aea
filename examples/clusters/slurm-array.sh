#!/usr/bin/env bash
# Builds a package on Slurm without any other engine: one job array for each round of parts, each
# waiting for the array before it.
#
#   SLOTS=200 STORE=/scratch/me/build PACKAGE=/scratch/me/out.pmtiles FOLDER=/scratch/me/jobs \
#       examples/clusters/slurm-array.sh --dem /data/dem/*.tif --osm /data/roads.osm.pbf
#
#   SLOTS    number of parts that are built at once
#   STORE    a folder on a file system that all nodes see, or s3://BUCKET/PREFIX
#   PACKAGE  the package to write
#   FOLDER   a folder that all nodes see, for the plan, lists of parts, and logs
#   MEMORY   memory of each part, in MiB [default: 2048]
#   THREADS  processors of each part [default: 1]
#   HOURS    time limit of each part [default: 4]
#   LEAST    smallest useful part, in estimated seconds on one core [default: that of
#            `corniche jobs`]
#   SBATCH   more options for sbatch, such as "--partition long --account geo"
#
# Run it on a login node. All other options are those of `corniche plan`. If a part fails, the
# rounds after it stay in the queue and never begin: cancel them (scancel), and run the same script
# again; parts that are complete end at once. Needs jq.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
# shellcheck source=examples/clusters/rounds.sh
. "$here/rounds.sh"
: "${SLOTS:?}" "${STORE:?}" "${PACKAGE:?}" "${FOLDER:?}"
memory=${MEMORY:-2048} threads=${THREADS:-1}

mkdir -p "$FOLDER"
plan=$FOLDER/plan.json
corniche plan "$@" -o "$plan" -O
corniche jobs "$plan" --slots "$SLOTS" ${LEAST:+--least-work "$LEAST"} >"$FOLDER/parts"
# A sixteenth of the memory is for what Slurm counts in addition to the process.
options=(--threads "$threads" --memory "$((memory - memory / 16))M" --quiet --store "$STORE")
# Arrays have a largest size; a longer round is several arrays.
largest=$(scontrol show config | awk '/^MaxArraySize/ { print $3 - 1 }')
before='' number=0
while next_round "$FOLDER/parts" "$FOLDER/round"; do
    number=$((number + 1))
    commands "$FOLDER/round" "$plan" "$PACKAGE" "${options[@]}" >"$FOLDER/round-$number"
    count=$(wc -l <"$FOLDER/round-$number")
    ids=()
    for ((first = 1; first <= count; first += largest)); do
        last=$((first + largest - 1 < count ? largest : count - first + 1))
        # shellcheck disable=SC2086  $SBATCH holds several options
        ids+=("$(sbatch --parsable --job-name "corniche-$number" --array "1-$last%$SLOTS" --cpus-per-task "$threads" --mem "${memory}M" \
            --time "${HOURS:-4}:00:00" --requeue --output "$FOLDER/%x-%A_%a.log" ${before:+--dependency "afterok:$before"} ${SBATCH:-} \
            "$here/slurm-part.sh" "$FOLDER/round-$number" "$((first - 1))")")
    done
    before=$(IFS=:; echo "${ids[*]}")
    end_round "$FOLDER/round"
done
check_all_made
echo "the package will be $PACKAGE, when job $before is done"
