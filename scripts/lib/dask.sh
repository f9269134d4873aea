# Sourced by scripts/test-dask and scripts/torture: a virtual environment with corniche-dask; the examples for clusters.
# shellcheck shell=bash

# Sets `dask_env` to a virtual environment with corniche-dask and pytest, or fails as python_package does.
make_dask_environment() {
    dask_env=${CARGO_TARGET_DIR:-target}/dask-env
    python_package "$dask_env" corniche-dask distributed
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
        skipped "jq and parallel cannot be installed here"
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
