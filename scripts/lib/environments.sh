# Sourced by scripts/lib/setup.sh: folders with packages of npm and of Python, in the target folder,
# each created once from a lock file.
# shellcheck shell=bash
#
# Lock files are updated by hand, and committed: with `npm install --package-lock-only
# --omit-lockfile-registry-resolved` next to a package.json, and with the versions that `pip install
# --dry-run --ignore-installed --report - PACKAGE` prints.

missing_for_node() {
    lacking node nodejs
    lacking npm npm
}

missing_for_environments() {
    python_for_environments >/dev/null || echo python3-venv
}

# Prints a Python interpreter that can create virtual environments and has version 3.11 or newer,
# which the lock files need.
python_for_environments() {
    local found
    found=$(python_with venv ensurepip) && "$found" -c 'import sys; sys.exit(sys.version_info < (3, 11))' && echo "$found"
}

# hash_of FILE…: prints the hash of their contents, in this order.
hash_of() { cat "$@" | { sha256sum 2>/dev/null || shasum -a 256; } | cut -d' ' -f1; }

# is_made_of FOLDER HASH: whether a folder was completely created from sources with this hash.
is_made_of() { [ "$(cat "$1/made-of" 2>/dev/null)" = "$2" ]; }

# npm_folder FOLDER PACKAGE.json: creates a folder with the packages that PACKAGE-lock.json pins.
# Fails with a message if they cannot be installed.
npm_folder() {
    local folder=$1 manifest=$2 lock=${2%.json}-lock.json new
    (install_missing missing_for_node) || return 1
    new=$(hash_of "$manifest" "$lock")
    if is_made_of "$folder" "$new"; then return 0; fi
    mkdir -p "$folder" && rm -f "$folder/made-of" || return 1
    cp "$manifest" "$folder/package.json" && cp "$lock" "$folder/package-lock.json" || return 1
    # Node 20 of some systems is older than cesium's own tools require; the library itself works
    # with it.
    (cd "$folder" && npm ci --ignore-scripts --no-audit --no-fund --loglevel=error --engine-strict=false) >&2 || return 1
    printf '%s\n' "$new" >"$folder/made-of"
}

# python_folder FOLDER LOCK [ARGUMENT OF PIP…]: creates a virtual environment with the packages that
# LOCK pins, or with the named packages in the versions that LOCK pins. Fails with a message if they
# cannot be installed.
python_folder() {
    local folder=$1 lock=$2 base new
    shift 2
    (install_missing missing_for_environments) && base=$(python_for_environments) || {
        say "there is no python3 of version 3.11 or newer with the module venv"
        return 1
    }
    # A package of this repository is next to its lock file, and declares its dependencies.
    local project
    project=$(dirname "$lock")/pyproject.toml
    [ -f "$project" ] || project=
    new=$("$base" -c 'import sys; print(sys.version_info[:2])') && new="$new $* $(hash_of "$lock" ${project:+"$project"})"
    if is_made_of "$folder" "$new"; then return 0; fi
    rm -rf "$folder"
    if [ $# -gt 0 ]; then set -- -c "$lock" "$@"; else set -- -r "$lock"; fi
    "$base" -m venv "$folder" >&2 &&
        "$folder/bin/python" -m pip install --quiet --disable-pip-version-check "$@" >&2 || return 1
    printf '%s\n' "$new" >"$folder/made-of"
}

# python_package FOLDER PACKAGE DEPENDENCY…: creates a virtual environment with a Python package
# from python/ and the dependencies of its tests. If packages cannot be installed, it reports that
# the tests are skipped, and fails; in CI the script ends if only our package cannot be installed.
python_package() {
    local folder=$1 name=$2 package=python/$2 ours=()
    shift 2
    # Its dependencies from this repository are in no registry.
    if grep -q '"corniche==' "$package/pyproject.toml"; then ours=(-e python/corniche); fi
    if python_folder "$folder" "$package/lock.txt" ${ours[@]+"${ours[@]}"} -e "$package[test]"; then return 0; fi
    if [ "${CI:-}" = true ] && [ ! -x "$folder/bin/python" ]; then fail 1 "no virtual environment can be created; see above"; fi
    if [ "${CI:-}" = true ] && "$folder/bin/python" -m pip install --quiet --disable-pip-version-check "$@"; then
        fail 1 "$name cannot be installed, although its dependencies can; see above"
    fi
    skipped "Python packages cannot be installed here, so $name is not tested"
    return 1
}
