"""The examples for Slurm and Kubernetes, with stand-ins of ``sbatch`` and ``kubectl`` that run what they are given on this machine."""

from __future__ import annotations

import os
import shutil
import stat
import subprocess
import sys
from pathlib import Path

import pytest

from conftest import ROOT, Planned

EXAMPLES = ROOT / "examples" / "clusters"

# : Runs the tasks of an array, in reverse order but after the jobs on which it depends; rejects
# unknown options.
SBATCH = """
import argparse, os, pathlib, subprocess, sys
parser = argparse.ArgumentParser(allow_abbrev=False)
for name in ["--job-name", "--array", "--cpus-per-task", "--mem", "--time", "--output", "--dependency"]:
    parser.add_argument(name)
for name in ["--parsable", "--requeue"]:
    parser.add_argument(name, action="store_true")
given, command = parser.parse_known_args()
done = pathlib.Path(os.environ["FAKE_FOLDER"]) / "slurm-jobs"
ids = done.read_text().split() if done.exists() else []
if given.dependency:
    kind, *before = given.dependency.split(":")
    assert kind == "afterok" and before and set(before) <= set(ids), (given.dependency, ids)
bounds, _, at_once = given.array.partition("%")
first, last = map(int, bounds.split("-"))
assert 1 <= first <= last <= 4 and int(at_once) > 0, given.array
for task in range(last, first - 1, -1):
    subprocess.run(command, check=True, env={**os.environ, "SLURM_ARRAY_TASK_ID": str(task)}, stdout=sys.stderr)
new = str(1000 + len(ids))
done.write_text(" ".join([*ids, new]))
print(new)
"""
SCONTROL = "print('MaxArraySize            = 5')"

#: Runs the pods of an Indexed Job; the volume of this machine is the pods' /build.
KUBECTL = """
import os, pathlib, subprocess, sys, yaml
folder = pathlib.Path(os.environ["FAKE_FOLDER"])
if sys.argv[1] == "apply":
    job = yaml.safe_load(sys.stdin)
    spec, (container,) = job["spec"], job["spec"]["template"]["spec"]["containers"]
    (variable,) = container["env"]
    commands = pathlib.Path(variable["value"].replace("/build", os.environ["VOLUME"], 1))
    mounted = folder / "mounted"
    mounted.write_text(commands.read_text().replace("/build/", os.environ["VOLUME"] + "/"))
    assert spec["completions"] == len(commands.read_text().splitlines()), spec
    environment = {**os.environ, variable["name"]: str(mounted)}
    codes = [
        subprocess.run(container["command"], env={**environment, "JOB_COMPLETION_INDEX": str(index)}, stdout=sys.stderr).returncode
        for index in range(spec["completions"])
    ]
    (folder / job["metadata"]["name"]).write_text("Failed" if any(codes) else "SuccessCriteriaMet Complete")
elif sys.argv[1] == "get":
    print((folder / sys.argv[3]).read_text())
else:
    assert sys.argv[1] == "delete", sys.argv
"""


@pytest.fixture
def stand_ins(tmp_path: Path, corniche: str) -> dict[str, str]:
    """An environment in which these commands come first on the path."""
    if shutil.which("jq") is None:
        pytest.skip("there is no jq")
    folder = tmp_path / "bin"
    folder.mkdir()
    for name, code in {"sbatch": SBATCH, "scontrol": SCONTROL, "kubectl": KUBECTL}.items():
        program = folder / name
        program.write_text(f"#!{sys.executable}\n{code}")
        program.chmod(program.stat().st_mode | stat.S_IXUSR)
    (folder / "corniche").symlink_to(corniche)
    return {**os.environ, "PATH": f"{folder}:{os.environ['PATH']}", "FAKE_FOLDER": str(tmp_path), "SLOTS": "2"}


def test_slurm(planned: Planned, stand_ins: dict[str, str], tmp_path: Path) -> None:
    """A round longer than the largest array is split into several arrays."""
    store, package = tmp_path / "store", tmp_path / "out.pmtiles"
    places = {"STORE": str(store), "PACKAGE": str(package), "FOLDER": str(tmp_path / "jobs"), "MEMORY": "300", "LEAST": "0.5"}
    subprocess.run([EXAMPLES / "slurm-array.sh", *planned.inputs], env={**stand_ins, **places}, check=True)
    assert package.read_bytes() == planned.bytes
    rounds = [len(path.read_text().splitlines()) for path in sorted((tmp_path / "jobs").glob("round-*"))]
    assert len((tmp_path / "slurm-jobs").read_text().split()) == sum(-(-count // 4) for count in rounds)


def test_kubernetes(planned: Planned, stand_ins: dict[str, str], tmp_path: Path) -> None:
    volume, package = tmp_path / "volume", tmp_path / "out.pmtiles"
    volume.mkdir()
    places = {"STORE": str(tmp_path / "store"), "PACKAGE": str(package), "VOLUME": str(volume), "MEMORY": "256M"}
    subprocess.run([EXAMPLES / "kubernetes.sh", *planned.inputs], env={**stand_ins, **places}, check=True)
    assert package.read_bytes() == planned.bytes
    # The package exists: its round fails, and so does the script.
    again = subprocess.run([EXAMPLES / "kubernetes.sh", *planned.inputs], env={**stand_ins, **places}, capture_output=True, text=True, check=False)
    assert again.returncode == 1 and "failed; kubectl logs" in again.stderr, again.stderr
    assert package.read_bytes() == planned.bytes
