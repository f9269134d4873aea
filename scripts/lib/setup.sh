# Sourced by scripts/demo, scripts/test and .ci/run: finds missing packages and installs them.
# shellcheck shell=bash

# shellcheck source=scripts/lib/environments.sh
. "$(dirname "${BASH_SOURCE[0]}")/environments.sh"

say() { printf '%s\n' "$*" >&2; }

# skipped REASON…: reports that a part of a script is skipped, and why; .ci/run repeats it at its
# end.
skipped() {
    say "skipped: $*"
    if [ -n "${CORNICHE_SKIPPED_PARTS:-}" ]; then printf '%s\n' "$*" >>"$CORNICHE_SKIPPED_PARTS"; fi
}

fail() {
    local code=$1
    shift
    say "error: $*"
    exit "$code"
}

# lacking PROGRAM PACKAGE…: prints the packages if the program is not on the path.
lacking() { command -v "$1" >/dev/null || printf '%s\n' "${@:2}"; }

# Prints the missing packages for building (compilers, the GDAL library and its headers) and for
# drawing (a Vulkan driver).
missing_for_build() {
    lacking cc gcc libc6-dev
    # meshoptimizer, which compresses tiles for other programs, is written in C++.
    lacking c++ g++
    lacking pkg-config pkg-config
    pkg-config --exists gdal 2>/dev/null || echo libgdal-dev
    has_vulkan_driver || echo mesa-vulkan-drivers
    has_library libvulkan.so.1 || echo libvulkan1
}

# Prints the packages for a python3 with numpy and shapely, for the independent check.
missing_for_check() {
    python_with numpy >/dev/null || echo python3-numpy
    python_with shapely >/dev/null || echo python3-shapely
    # Tests convert files with ogr2ogr.
    lacking ogr2ogr gdal-bin
    # The oracle for areas needs this.
    lacking osmium osmium-tool
    # This is a web server for packages read by address.
    lacking busybox busybox
    # Tests send signals with the program kill; a minimal Debian only has the shell's built-in kill.
    type -P kill >/dev/null || echo procps
    # These packages are needed to install moto's server, the test server for object storage.
    python_with moto.server >/dev/null || python_for_environments >/dev/null || echo python3-venv
}

# Prints the packages for tests of the window: a virtual display, and a program that moves the mouse
# there.
missing_for_window() {
    [ "$(uname -s)" != Linux ] && return 0
    lacking Xvfb xvfb
    lacking xdotool xdotool
    missing_for_view
}

# Prints the libraries that a window loads while it opens; desktops with X11 or Wayland have them.
missing_for_view() {
    [ "$(uname -s)" != Linux ] && return 0
    has_library libX11-xcb.so.1 || echo libx11-xcb1
    has_library libXcursor.so.1 || echo libxcursor1
    has_library libXi.so.6 || echo libxi6
    has_library libXrandr.so.2 || echo libxrandr2
    has_library libxkbcommon-x11.so.0 || echo libxkbcommon-x11-0
}

# Whether a shared library is installed. Only Linux has `ldconfig` to find out; elsewhere the answer
# is yes.
has_library() {
    local libraries
    [ "$(uname -s)" != Linux ] && return 0
    libraries=$(PATH=$PATH:/sbin:/usr/sbin ldconfig -p 2>/dev/null) || return 1
    grep -qF "$1" <<<"$libraries"
}

has_vulkan_driver() {
    [ "$(uname -s)" != Linux ] && return 0 # macOS draws with Metal
    local folder file
    for folder in ${VULKAN_DRIVERS:-/usr/share/vulkan/icd.d /etc/vulkan/icd.d /usr/local/share/vulkan/icd.d}; do
        for file in "$folder"/*.json; do
            [ -e "$file" ] && return 0
        done
    done
    return 1
}

# Prints the first Python interpreter that can import all the named modules. Debian's own
# interpreter is tried first, because Debian's packages are installed for it, even if another
# program is called python3.
python_with() {
    local candidate modules
    modules=$(IFS=,; echo "$*")
    for candidate in /usr/bin/python3 python3; do
        if command -v "$candidate" >/dev/null && "$candidate" -c "import $modules" 2>/dev/null; then
            echo "$candidate"
            return 0
        fi
    done
    return 1
}

# Prints a Python interpreter that has moto's server, the test server for object storage. If there
# is none, a virtual environment is created in the target folder, once. Fails with a message if that
# is not possible.
object_storage_python() {
    local folder=${CARGO_TARGET_DIR:-target}/object-storage
    python_with moto.server && return 0
    python_folder "$folder" tests/object-storage-lock.txt || return 1
    echo "$(cd "$folder" && pwd)/bin/python"
}

# The oldest cargo that can build this workspace: `rust-version` of the manifest.
oldest_cargo() { sed -n 's/^rust-version = "\(.*\)"$/\1/p' Cargo.toml; }

# Whether version $1 is at least version $2, number by number.
is_at_least() {
    awk -v have="$1" -v need="$2" 'BEGIN {
        split(have, h, "[.-]"); split(need, n, ".")
        for (i = 1; i <= 3; i++) if (h[i] + 0 != n[i] + 0) exit h[i] + 0 < n[i] + 0
    }'
}

# Without this check an older cargo would fail with an unhelpful message about the manifest.
require_cargo() {
    local need have
    need=$(oldest_cargo)
    [ -n "$need" ] || fail 1 "Cargo.toml names no rust-version"
    command -v cargo >/dev/null ||
        fail 2 "cargo is missing. Install Rust from https://rustup.rs, open a new shell, and run this again"
    have=$(cargo --version | awk '{ print $2 }')
    is_at_least "$have" "$need" && return 0
    if command -v rustup >/dev/null; then fail 2 "cargo $have is too old, $need is needed: run \`rustup update stable\`"; fi
    fail 2 "$(command -v cargo) is cargo $have, $need is needed. The packages of Debian and Ubuntu are too old:" \
        "install Rust as https://rustup.rs says, open a new shell, and run this again"
}

# The approximate disk space that compiling needs in the target folder.
BUILD_DISK_GB=4

# Fails before a build that cannot fit on the disk; an existing target folder already has most of
# it.
require_disk() {
    local folder=${CARGO_TARGET_DIR:-target} free_kb
    [ -d "$folder/debug/deps" ] && return 0
    while [ ! -d "$folder" ]; do folder=$(dirname "$folder"); done
    free_kb=$(df -Pk "$folder" | awk 'NR == 2 { print $4 }')
    [ "$free_kb" -ge $((BUILD_DISK_GB * 1000000)) ] ||
        fail 2 "compiling needs $BUILD_DISK_GB GB of disk space, $((free_kb / 1000000)) GB are free; name a folder elsewhere: CARGO_TARGET_DIR=FOLDER"
}

# Installs the packages that the named functions print. If none is missing, it does nothing, and
# does not even run `apt-get update`.
install_missing() {
    local packages=() probe line as_root=()
    require_cargo
    for probe in "$@"; do
        while IFS= read -r line; do packages+=("$line"); done < <("$probe")
    done
    [ ${#packages[@]} -eq 0 ] && return 0
    if ! command -v apt-get >/dev/null; then
        say "missing packages, by their Debian names: ${packages[*]}"
        say "install the corresponding packages of your system: macOS: brew install gdal pkg-config"
        say "  Fedora: dnf install gcc gcc-c++ gdal-devel proj-devel pkgconf mesa-vulkan-drivers vulkan-loader; for scripts/test also numpy and shapely for Python"
        exit 2
    fi
    if [ "$(id -u)" -ne 0 ]; then
        command -v sudo >/dev/null || fail 2 "run as root: apt-get install ${packages[*]}"
        as_root=(sudo)
    fi
    say "installing Debian packages: ${packages[*]}"
    # `env` carries the setting through sudo, which drops the environment.
    ${as_root[@]+"${as_root[@]}"} apt-get update -qq >&2 || fail 1 "apt-get update failed; see above"
    ${as_root[@]+"${as_root[@]}"} env DEBIAN_FRONTEND=noninteractive \
        apt-get install -y -qq --no-install-recommends "${packages[@]}" >&2 ||
        fail 1 "could not install ${packages[*]}; see above"
    for probe in "$@"; do
        line=$("$probe" | tr '\n' ' ')
        [ -z "$line" ] || fail 1 "still missing after installing: $line"
    done
}

# Builds the program and sets `corniche` to its path.
build_corniche() {
    cargo build --locked -p corniche-cli
    corniche=${CARGO_TARGET_DIR:-target}/debug/corniche
    [ -x "$corniche" ] || fail 1 "the build created no $corniche"
}
