#!/usr/bin/env bash
# Builds a package with GNU parallel, on this machine or on several.
#
#   SLOTS=4 STORE=work PACKAGE=out.pmtiles examples/clusters/gnu-parallel.sh \
#       --dem dem.tif --osm roads.osm.pbf
#
#   SLOTS     number of parts that each machine builds at once
#   MACHINES  number of machines [default: 1]
#   STORE     a folder that all machines see, or s3://BUCKET/PREFIX
#   PACKAGE   the package to write
#   MEMORY    memory of each process, which has one thread [default: 1G]
#   LEAST     smallest useful part, in estimated seconds on one core [default: that of
#             `corniche jobs`]
#
# All other options are those of `corniche plan`. For several machines, set
# PARALLEL='--sshloginfile machines --workdir .' (see `man parallel`); they need `corniche`, the
# inputs and the store at the same paths. Repeat the command to resume a stopped build. Needs jq and
# parallel.
set -euo pipefail
# shellcheck source=examples/clusters/rounds.sh
. "$(dirname "$0")/rounds.sh"
: "${SLOTS:?}" "${STORE:?}" "${PACKAGE:?}"

slots=$((SLOTS * ${MACHINES:-1}))

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# The plan is the same every time, so a second run resumes. It is next to the package, where other
# machines see it.
plan=$(realpath -m "$PACKAGE").plan.json
corniche plan "$@" -o "$plan" -O >/dev/null
options=(--threads 1 --memory "${MEMORY:-1G}" --quiet --store "$STORE")

corniche jobs "$plan" --slots "$slots" ${LEAST:+--least-work "$LEAST"} >"$work/jobs"
while next_round "$work/jobs" "$work/round"; do
    # A part that fails is tried three times, and resumes from the store.
    commands "$work/round" "$plan" "$PACKAGE" "${options[@]}" | parallel --jobs "$SLOTS" --retries 3 --halt soon,fail=1
    end_round "$work/round"
    # Once the roads are in the store, the work for each tile is known better.
    corniche jobs "$plan" --slots "$slots" ${LEAST:+--least-work "$LEAST"} --store "$STORE" >"$work/jobs"
done
check_all_made
rm "$plan"
