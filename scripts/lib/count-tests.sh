# Sourced by scripts/test: the summary of a run of cargo test.
# shellcheck shell=bash

# count_tests OUTPUT SKIPPED TIER: sums up the output of cargo test, and prints why tests were
# skipped: those that reported a reason (lines `binary test: reason` in the file SKIPPED) and those
# that are too slow for the quick tier.
count_tests() {
    local passed failed slow skipped
    read -r passed failed slow < <(awk '
        /^test result:/ { passed += $4; failed += $6; slow += $8 }
        END { print passed + 0, failed + 0, slow + 0 }' "$1")
    if ! grep -q '^test result:' "$1"; then say "no test ran: they do not compile, see above"; fi
    # A test may report several times that a part of it is skipped; it counts as one test.
    skipped=$(sed 's/: .*//' "$2" | sort -u | wc -l | tr -d ' ')
    if [ "$failed" -gt 0 ]; then
        say ""
        say "failed:"
        say "$(awk '/^test .* FAILED$/ { print "  " $2 }' "$1" | sort -u)"
    fi
    if [ "$skipped" -gt 0 ]; then
        say ""
        say "skipped, or a part of them, and why:"
        # The reason follows the first `: `; names of tests only contain `::`. A test counts once
        # for each of its reasons.
        say "$(sort -u "$2" | sed 's/^[^:]*\(::[^:]*\)*: //' | sort | uniq -c | sort -rn | awk '{
            number = $1
            $1 = number == 1 ? "  1 test" : "  " number " tests"
            if ($2 == "need") { if (number == 1) $2 = "needs" } else { $1 = $1 ":" }
            print
        }')"
    fi
    if [ "$3" = quick ]; then
        say ""
        say "not part of this tier: $slow slow tests, and the examples in doc comments; scripts/test ci runs them"
    else
        slow=0
    fi
    if [ "$3" != full ]; then say "scripts/test full runs all cases; CONTRIBUTING.md names the campaigns beyond it"; fi
    say ""
    printf '%d passed, %d failed, %d skipped\n' $((passed - skipped)) "$failed" $((skipped + slow))
}
