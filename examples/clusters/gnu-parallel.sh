#!/usr/bin/env bash
# A build by GNU parallel, on this machine or on several.
#
#   SLOTS=4 STORE=work PACKAGE=out.pmtiles examples/clusters/gnu-parallel.sh --dem dem.tif --osm roads.osm.pbf
#
#   SLOTS     parts that are made at once, on each machine
#   MACHINES  how many machines there are [default: 1]
#   STORE     a folder that all machines see, or s3://BUCKET/PREFIX
#   PACKAGE   the package to write
#   MEMORY    memory of each process [default: 1G]; each has one thread
#   LEAST     no part is made smaller than this without need, in estimated seconds on one core [default: what corniche jobs chooses]
#
# All other options are those of `corniche plan`. Several machines: PARALLEL='--sshloginfile machines --workdir .' (see `man parallel`); they need
# `corniche`, the inputs and the store at the same paths. The same command goes on after anything was stopped. Needs jq and parallel.
set -euo pipefail
# shellcheck source=examples/clusters/rounds.sh
. "$(dirname "$0")/rounds.sh"
: "${SLOTS:?}" "${STORE:?}" "${PACKAGE:?}"

slots=$((SLOTS * ${MACHINES:-1}))

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# A plan that is the same every time, so a second run goes on. It lies beside the package, where other machines see it.
plan=$(realpath -m "$PACKAGE").plan.json
corniche plan "$@" -o "$plan" -O >/dev/null
options=(--threads 1 --memory "${MEMORY:-1G}" --quiet --store "$STORE")

corniche jobs "$plan" --slots "$slots" ${LEAST:+--least-work "$LEAST"} >"$work/jobs"
while next_round "$work/jobs" "$work/round"; do
    # A part that fails is tried three times. What was done of it is kept.
    commands "$work/round" "$plan" "$PACKAGE" "${options[@]}" | parallel --jobs "$SLOTS" --retries 3 --halt soon,fail=1
    end_round "$work/round"
    # Once the roads are in the store, the work of each tile is known better.
    corniche jobs "$plan" --slots "$slots" ${LEAST:+--least-work "$LEAST"} --store "$STORE" >"$work/jobs"
done
check_all_made
rm "$plan"
