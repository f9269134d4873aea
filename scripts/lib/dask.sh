# Sourced by scripts/test-dask and scripts/torture: a virtual environment with corniche-dask; the examples for clusters.
# shellcheck shell=bash

# Sets `dask_env` to a virtual environment with corniche-dask and pytest. Says so and fails where there are no packages to be had; in CI that ends
# the script if only ours cannot be installed.
make_dask_environment() {
    local package=python/corniche-dask
    dask_env=${CARGO_TARGET_DIR:-target}/dask-env
    if python_folder "$dask_env" $package/lock.txt -e "$package[test]"; then return 0; fi
    if [ "${CI:-}" = true ] && [ ! -x "$dask_env/bin/python" ]; then fail 1 "no virtual environment can be made; see above"; fi
    if [ "${CI:-}" = true ] && "$dask_env/bin/python" -m pip install --quiet --disable-pip-version-check distributed; then
        fail 1 "corniche-dask cannot be installed, though its dependencies can; see above"
    fi
    say "skipped: Python packages cannot be installed here, so corniche-dask is not tested"
    return 1
}

missing_for_examples() {
    command -v jq >/dev/null || echo jq
    command -v parallel >/dev/null || echo parallel
}

# The examples that need a cluster are only parsed.
examples_parse() {
    local script
    for script in examples/clusters/*.sh; do bash -n "$script"; done
    "$dask_env/bin/python" - examples/clusters <<'PYTHON'
import ast, pathlib, sys, yaml

folder = pathlib.Path(sys.argv[1])
for file in folder.glob("*.py"):
    ast.parse(file.read_text(), str(file))
for file in folder.glob("*.yaml"):
    spec = yaml.safe_load(file.read_text())["spec"]
    container = spec["template"]["spec"]["containers"][0]
    assert spec["completionMode"] == "Indexed" and "JOB_COMPLETION_INDEX" in container["command"][-1], file
    assert spec["podFailurePolicy"]["rules"][0]["onExitCodes"]["containerName"] == container["name"], file
PYTHON
}

# GNU parallel makes the sample, twice: the second time everything but the package is there already.
example_runs() {
    local folder inputs=(--dem "$PWD/data-samples/pass/pass-dem.tif" --osm "$PWD/data-samples/pass/pass.osm.pbf" --max-error 10) run
    # Its failure ends a shell.
    if ! (install_missing missing_for_examples); then
        say "skipped: jq and parallel cannot be installed here"
        return 0
    fi
    folder=$(mktemp -d)
    mkdir "$folder/bin" && ln -s "$CORNICHE" "$folder/bin/corniche"
    "$CORNICHE" build "${inputs[@]}" --quiet -o "$folder/whole.pmtiles"
    for run in first second; do
        PATH=$folder/bin:$PATH SLOTS=2 MEMORY=256M LEAST=0.05 STORE=$folder/store PACKAGE=$folder/$run.pmtiles examples/clusters/gnu-parallel.sh "${inputs[@]}" >/dev/null ||
            fail 1 "examples/clusters/gnu-parallel.sh failed; see above"
        cmp "$folder/whole.pmtiles" "$folder/$run.pmtiles"
    done
    rm -rf "$folder"
    say "examples/clusters/gnu-parallel.sh: the bytes of a build, twice"
}
