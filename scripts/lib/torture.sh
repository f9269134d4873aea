# Sourced by scripts/torture: the functions that its sections share.
# shellcheck shell=bash disable=SC2154

failures=0
mounted=''

begin_table() {
    printf '| section | what | result | figures |\n|---|---|---|---|\n' >"$work/table.md"
}

# row SECTION WHAT RESULT FIGURES: adds a row to the table; RESULT is passed, failed, skipped or
# measured.
row() {
    printf '| %s | %s | %s | %s |\n' "$@" >>"$work/table.md"
    say "$1, $2: $3: $4"
    [ "$3" != failed ] || failures=$((failures + 1))
}

# Prints the table and unmounts everything, however the script ends.
end() {
    local code=$?
    if [ -n "$mounted" ]; then umount "$mounted" || say "error: $mounted is still mounted"; fi
    cat "$work/table.md"
    if ! $keeps_work && [ -z "$(findmnt -rno TARGET -R "$work/small" 2>/dev/null)" ]; then rm -rf "$work"; fi
    [ $code -eq 0 ] && [ $failures -eq 0 ] && exit 0
    say "$failures failed"
    exit $((code > 0 ? code : 1))
}

# Empties folders, or creates them.
fresh() {
    local folder
    for folder in "$@"; do rm -rf "$folder" && mkdir -p "$folder"; done
}

now_ms() { date +%s%3N; }

# Prints names and digests of all files in a folder, so that leftovers are noticed, too.
digests() { (cd "$1" && find . -type f | LC_ALL=C sort | xargs -r sha256sum); }

# Whether a store has a journal with more than its header.
has_work() { [ -n "$(find "$1" -name '*.journal' -size +48c 2>/dev/null)" ]; }

build_tools() {
    [ -z "$tools" ] || return 0
    cargo build --locked -p corniche-testing --features rasters --example repeat_dem
    cargo build --locked -p corniche-osm --example repeat_extract
    tools=${CARGO_TARGET_DIR:-target}/debug/examples
}

# make_dem SIDE: creates dem-SIDE.tif from N47E009, completely or not at all.
make_dem() {
    [ -f "$work/dem-$1.tif" ] && return 0
    build_tools
    "$tools/repeat_dem" "$data/liechtenstein/N47E009.hgt" "$work/part.tif" "$1"
    mv "$work/part.tif" "$work/dem-$1.tif"
}

# measure STORE COMMAND…: runs a command and sets `measured` to "WALL,CPU PEAK DISK": seconds, bytes
# of memory, most bytes in the store.
measure() {
    local store=$1 disk=0 now pid wall user system peak code=0
    shift
    /usr/bin/time -f '%e %U %S %M' -o "$work/time" "$@" &
    pid=$!
    while kill -0 $pid 2>/dev/null; do
        now=$(du -s --block-size=1 "$store" 2>/dev/null | cut -f1 || true)
        if [ "${now:-0}" -gt $disk ]; then disk=$now; fi
        sleep 0.2
    done
    wait $pid || code=$?
    read -r wall user system peak < <(tail -n 1 "$work/time")
    measured="$wall,$(awk -v u="$user" -v s="$system" 'BEGIN { print u + s }') $((peak * 1024)) $disk"
    return $code
}

# Reads the output of `corniche plan --json`: bytes of the store and of the package.
estimate_of() {
    python3 -c 'import json, sys; e = json.load(sys.stdin)["estimate"]; print(e["store_bytes"], e["package_bytes"])'
}

# within BYTES LIMIT: whether BYTES are within LIMIT, which has the form of --memory.
within() { [ "$1" -le "$(numfmt --from=iec "$2")" ]; }

# is_near BYTES ESTIMATE: whether BYTES are within 20 % of the estimate.
is_near() { awk -v used="$1" -v estimate="$2" 'BEGIN { exit !(used >= 0.8 * estimate && used <= 1.2 * estimate) }'; }

# mount_small FOLDER: mounts a disk of 400 MB, stored in a file, at that folder.
mount_small() {
    mkdir -p "$1"
    truncate -s 400M "$work/small.image"
    mkfs.ext4 -q -F -m 0 "$work/small.image" && mount -o loop "$work/small.image" "$1" || return 1
    mounted=$1
}

# fill_up DISK KIB: fills a disk until only KIB are free.
fill_up() {
    local free_kb
    free_kb=$(df --output=avail -k "$1" | tail -n 1)
    fallocate -l "$((free_kb - $2))K" "$1/filler"
}

# fails_full SECTION WHAT FOLDER COMMAND…: the command must end with exit code 1, report that the
# disk is full, and leave no package in FOLDER.
fails_full() {
    local section=$1 what=$2 folder=$3 code=0
    shift 3
    "$@" 2>"$work/said" || code=$?
    if [ $code -eq 1 ] && grep -qiE 'disk (is )?full|No space left' "$work/said" && [ ! -e "$folder/out.pmtiles" ]; then return 0; fi
    row "$section" "$what" failed "on a full disk: exit code $code, $(tr '\n|' '  ' <"$work/said")"
    return 1
}

# goes_on SECTION WHAT FOLDER DIGESTS COMMAND…: with --resume the command must give the same bytes.
goes_on() {
    local section=$1 what=$2 folder=$3 whole=$4
    shift 4
    if "$@" --resume && [ "$(digests "$folder")" = "$whole" ]; then
        row "$section" "$what" passed "full, then resumed: the same bytes"
    else
        row "$section" "$what" failed "different bytes, or none: $(ls -A "$folder" | tr '\n' ' ')"
    fi
}
