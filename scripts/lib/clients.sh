# Sourced by scripts/test-clients: a folder with packages of npm, and Chromium.
# shellcheck shell=bash

# Sets `clients_env` to a folder with the packages and the programs of tests/clients. Says so and fails where there are none to be had.
make_clients_environment() {
    local new
    clients_env=${CARGO_TARGET_DIR:-$PWD/target}/clients
    if ! (install_missing missing_for_clients); then
        say "skipped: Node and npm cannot be installed here, so exports are not read by other programs"
        return 1
    fi
    mkdir -p "$clients_env"
    cp tests/clients/*.mjs tests/clients/*.py tests/clients/package.json "$clients_env"
    new=$(cat tests/clients/package.json)
    if [ "$(cat "$clients_env/made-of" 2>/dev/null)" = "$new" ]; then return 0; fi
    # Node 20 of some systems is older than cesium's own tools want; the library itself does not care.
    if (cd "$clients_env" && npm install --ignore-scripts --no-audit --no-fund --loglevel=error --engine-strict=false); then
        printf '%s\n' "$new" >"$clients_env/made-of"
        return 0
    fi
    say "skipped: packages of npm cannot be installed here, so exports are not read by other programs"
    return 1
}

missing_for_clients() {
    command -v node >/dev/null || echo nodejs
    command -v npm >/dev/null || echo npm
}

missing_for_browser() {
    command -v chromium >/dev/null || echo chromium
}

has_browser() {
    if (install_missing missing_for_browser); then return 0; fi
    say "skipped: Chromium cannot be installed here, so no page is opened"
    return 1
}

# Prints a Python interpreter that has quantized-mesh-tile; a virtual environment is made in the target folder, once. Says so and fails where that cannot
# be done.
terrain_python() {
    local folder=${CARGO_TARGET_DIR:-$PWD/target}/terrain-python base
    if "$folder/bin/python" -c "import quantized_mesh_tile" 2>/dev/null; then
        echo "$folder/bin/python"
        return 0
    fi
    if (install_missing missing_for_environments) && base=$(python_for_environments) &&
        "$base" -m venv "$folder" >&2 && "$folder/bin/python" -m pip install -q 'quantized-mesh-tile==0.7.0' >&2; then
        echo "$folder/bin/python"
        return 0
    fi
    say "skipped: quantized-mesh-tile cannot be installed here, so terrain tiles are not decoded by another program"
    return 1
}

missing_for_environments() {
    python_for_environments >/dev/null || echo python3-venv
}
