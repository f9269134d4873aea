# Sourced by scripts/test-dask and scripts/torture: a virtual environment with corniche-dask, and
# the packages for the cluster examples.
# shellcheck shell=bash

# Sets `dask_env` to a virtual environment with corniche-dask and pytest, or fails as python_package
# does.
make_dask_environment() {
    dask_env=${CARGO_TARGET_DIR:-target}/dask-env
    python_package "$dask_env" corniche-dask distributed
}

missing_for_examples() {
    command -v jq >/dev/null || echo jq
    command -v parallel >/dev/null || echo parallel
}
