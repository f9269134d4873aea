# Sourced by scripts/demo: fetches one square of public elevation data.
# shellcheck shell=bash

# SRTM-based, 1 arc second: 3601 × 3601 heights of two bytes.
SRTM_BYTES=25934402

# Whether a file is such a square with heights that occur on Earth; says why not.
is_srtm_square() {
    local bytes range
    bytes=$(wc -c <"$1" | tr -d ' ')
    if [ "$bytes" -ne "$SRTM_BYTES" ]; then
        say "$1 has $bytes bytes, not the $SRTM_BYTES of a 1 arc second square"
        return 1
    fi
    # Big-endian 16-bit numbers; -32768 means no data.
    range=$(od -An -v -t u1 "$1" | awk '
        {
            for (i = 1; i < NF; i += 2) {
                v = $i * 256 + $(i + 1)
                if (v > 32767) v -= 65536
                if (v == -32768) continue
                if (!n++) low = high = v
                if (v < low) low = v
                if (v > high) high = v
            }
        }
        END { print (n ? low : "none"), (n ? high : "none") }')
    case $range in
    *none*)
        say "$1 holds no heights"
        return 1
        ;;
    esac
    if [ "${range% *}" -lt -500 ] || [ "${range#* }" -gt 9000 ]; then
        say "$1 holds heights from ${range% *} to ${range#* } m; it is damaged"
        return 1
    fi
}

# fetch_srtm NAME FOLDER: puts NAME.hgt into FOLDER, whole and checked or not at all.
fetch_srtm() {
    local name=$1 folder=$2 base url part
    base=${CORNICHE_SRTM_URL:-https://elevation-tiles-prod.s3.amazonaws.com/skadi}
    url=$base/${name:0:3}/$name.hgt.gz
    # Only whole and checked files get that name.
    [ -f "$folder/$name.hgt" ] && return 0
    mkdir -p "$folder"
    part=$folder/.$name.part
    rm -f "$part" "$part.gz"
    say "downloading $url"
    if ! curl --fail --location --silent --show-error --connect-timeout 15 --max-time 900 --retry 2 -o "$part.gz" "$url" >&2; then
        rm -f "$part.gz"
        say "error: could not download $url"
        say "Without a network, put $name.hgt into a folder and name it: CORNICHE_DATA=FOLDER scripts/demo liechtenstein"
        return 1
    fi
    if ! gzip -dc "$part.gz" >"$part" 2>/dev/null; then
        rm -f "$part" "$part.gz"
        say "error: what $url gave is no gzip file (an error page?)"
        return 1
    fi
    rm -f "$part.gz"
    say "checking $name"
    if ! is_srtm_square "$part"; then
        rm -f "$part"
        say "error: what $url gave is not usable; nothing was kept"
        return 1
    fi
    mv "$part" "$folder/$name.hgt"
}
