# Sourced by the other scripts: finds the parts of a build that can be built next.
# shellcheck shell=bash
#
# `corniche jobs` prints one part per line. `after` names the steps whose parts must all be complete
# first. A round is all parts that can be built once the steps in $done_steps are complete: first
# hashes, heights and shares (chunks of the extract), then top, and so on; the package is the last one.

done_steps='[]'

# next_round FILE ROUND: writes the parts of the next round, largest first; false if there are none.
# FILE has the output of `corniche jobs`.
next_round() {
    jq -c --slurp --argjson done "$done_steps" '
        map(select((.step as $step | $done | index($step) | not) and (.after - $done) == []))
        | sort_by(-.work) | .[]' "$1" >"$2" || exit 1
    [ -s "$2" ]
}

# check_all_made: fails unless the last round was the package's.
check_all_made() {
    case $done_steps in
    *'"merge"'*) ;;
    *) echo "the list of parts ended before the package" >&2 && exit 1 ;;
    esac
}

# end_round ROUND: records that its steps are complete.
end_round() {
    done_steps=$(jq -c --slurp --argjson done "$done_steps" '$done + map(.step) | unique' "$1")
}

# commands ROUND PLAN PACKAGE OPTION…: the command line of each part of a round; options are those
# of both `corniche part` and `corniche merge`.
commands() {
    local round=$1 plan=$2 package=$3
    shift 3
    jq -r --arg plan "$plan" --arg package "$package" --arg options "$(printf '%q ' "$@")" '
        if .step == "merge" then "corniche merge \($plan | @sh) \($options) \(.args | @sh) -o \($package | @sh)"
        else "corniche part \($plan | @sh) \($options) \(.args | @sh)" end' "$round"
}
