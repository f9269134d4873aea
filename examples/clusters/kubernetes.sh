#!/usr/bin/env bash
# Builds a package on Kubernetes without any other engine: one Indexed Job for each round of parts.
#
#   SLOTS=16 VOLUME=/mnt/build examples/clusters/kubernetes.sh \
#       --dem /build/dem.tif --osm /build/roads.osm.pbf
#
#   SLOTS    number of pods at once
#   VOLUME   path on this machine of the volume that pods mount at /build (claim corniche-work,
#            ReadWriteMany); plan and lists are written there
#   STORE    the store, as pods see it [default: /build/store], or s3://BUCKET/PREFIX
#   PACKAGE  the package, as pods see it [default: /build/out.pmtiles]
#   MEMORY   memory of each process [default: 1792M, for pods of 2Gi]
#   LEAST    smallest useful part, in estimated seconds on one core [default: that of
#            `corniche jobs`]
#
# All other options are those of `corniche plan`, with paths as pods see them: run this in a pod
# with the same volume, or mount the volume at the same path on this machine. Change image, volume
# and resources in kubernetes-round.yaml. Repeat the command to resume a stopped build. Needs
# corniche, jq, sed and kubectl.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
# shellcheck source=examples/clusters/rounds.sh
. "$here/rounds.sh"
: "${SLOTS:?}" "${VOLUME:?}"
store=${STORE:-/build/store} package=${PACKAGE:-/build/out.pmtiles}

corniche plan "$@" -o "$VOLUME/plan.json" -O
corniche jobs "$VOLUME/plan.json" --slots "$SLOTS" ${LEAST:+--least-work "$LEAST"} >"$VOLUME/parts"
options=(--threads 1 --memory "${MEMORY:-1792M}" --quiet --store "$store")
number=0
while next_round "$VOLUME/parts" "$VOLUME/round.json"; do
    number=$((number + 1))
    commands "$VOLUME/round.json" /build/plan.json "$package" "${options[@]}" >"$VOLUME/round-$number"
    count=$(wc -l <"$VOLUME/round-$number")
    kubectl delete job "corniche-round-$number" --ignore-not-found
    sed -e "s|name: corniche-round|name: corniche-round-$number|" -e "s|value: /build/round|value: /build/round-$number|" \
        -e "s|completions: .*|completions: $count|" -e "s|parallelism: .*|parallelism: $SLOTS|" -e "s|backoffLimit: .*|backoffLimit: $((3 * count))|" \
        "$here/kubernetes-round.yaml" | kubectl apply -f -
    while true; do
        state=$(kubectl get job "corniche-round-$number" -o 'jsonpath={.status.conditions[?(@.status=="True")].type}') || state=''
        case " $state " in
        *" Complete "*) break ;;
        *" Failed "*) echo "round $number failed; kubectl logs job/corniche-round-$number says why" >&2 && exit 1 ;;
        esac
        sleep 10
    done
    end_round "$VOLUME/round.json"
done
check_all_made
