# Sourced by scripts/test-clients: a folder with packages of npm, and Chromium.
# shellcheck shell=bash

# Sets `clients_env` to a folder with the packages and the programs of tests/clients. Says so and fails where there are none to be had.
make_clients_environment() {
    clients_env=${CARGO_TARGET_DIR:-$PWD/target}/clients
    if ! npm_folder "$clients_env" tests/clients/package.json; then
        skipped "packages of npm cannot be installed here, so exports are not read by other programs"
        return 1
    fi
    cp tests/clients/*.mjs tests/clients/*.py "$clients_env"
}

missing_for_browser() {
    command -v chromium >/dev/null || echo chromium
}

has_browser() {
    if (install_missing missing_for_browser); then return 0; fi
    skipped "Chromium cannot be installed here, so no page is opened"
    return 1
}

# Prints a Python interpreter that has quantized-mesh-tile; a virtual environment is made in the target folder, once. Says so and fails where that cannot
# be done.
terrain_python() {
    local folder=${CARGO_TARGET_DIR:-$PWD/target}/terrain-python
    if python_folder "$folder" tests/clients/terrain-lock.txt; then
        echo "$folder/bin/python"
        return 0
    fi
    skipped "quantized-mesh-tile cannot be installed here, so terrain tiles are not decoded by another program"
    return 1
}
