# Sourced by scripts/test: what a run of cargo test came to.
# shellcheck shell=bash

# count_tests OUTPUT SKIPPED TIER: sums up what cargo test printed, and shows why tests were skipped: those that said so (lines
# `test: reason` in the file SKIPPED) and those left out of this tier as slow.
count_tests() {
    local passed failed slow skipped names
    read -r passed failed slow < <(awk '
        /^test result:/ { passed += $4; failed += $6; slow += $8 }
        END { print passed + 0, failed + 0, slow + 0 }' "$1")
    # A test may say several times that a part of it is skipped; it is one test.
    skipped=$(sed 's/: .*//' "$2" | sort -u | wc -l)
    if [ "$failed" -gt 0 ]; then
        say ""
        say "failed:"
        names=$(awk '/^test .* FAILED$/ { print "  " $2 }' "$1" | sort -u)
        say "$names"
    fi
    if [ "$skipped" -gt 0 ]; then
        say ""
        say "skipped, and why:"
        # The reason follows the first `: `; names of tests hold `::` alone.
        say "$(sed 's/^[^ ]*: //' "$2" | sort | uniq -c | sort -rn)"
    fi
    if [ "$slow" -gt 0 ]; then
        say ""
        say "$slow slow tests are not part of this tier; scripts/test ci runs them, too"
    fi
    if [ "$3" != full ]; then say "scripts/test full runs all cases; CONTRIBUTING.md names the campaigns beyond it"; fi
    say ""
    printf '%d passed, %d failed, %d skipped\n' $((passed - skipped)) "$failed" $((skipped + slow))
}
