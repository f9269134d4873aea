"""Builds a package with Dask on Slurm. Workers are Slurm jobs; while there is work, more are started.

    corniche plan --dem /data/dem/*.tif --osm /data/roads.osm.pbf -o /scratch/me/plan.json
    python dask-slurm.py /scratch/me/plan.json /scratch/me/build /scratch/me/out.pmtiles --jobs 50

Needs ``pip install './python/corniche-dask[slurm]'`` in an environment that all nodes see, and ``corniche`` on the ``PATH`` of all nodes.
"""

import argparse
import sys

import dask
from dask_jobqueue.slurm import SLURMCluster
from distributed import Client

from corniche_dask import CornicheError, build
from corniche_dask.progress import Progress


def main() -> int:
    """Starts a cluster, builds, and prints the time of each step."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("plan")
    parser.add_argument("store")
    parser.add_argument("output")
    parser.add_argument("--jobs", type=int, default=10, help="largest number of Slurm jobs")
    parser.add_argument("--queue", help="partition")
    parser.add_argument("--account")
    given = parser.parse_args()
    # Jobs that end at their time limit, or are preempted, do not count as failures of the part that
    # they were building.
    dask.config.set({"distributed.scheduler.allowed-failures": 20})
    cluster = SLURMCluster(
        queue=given.queue,
        account=given.account,
        cores=4,
        processes=1,
        memory="8GB",
        walltime="04:00:00",
        # One part at a time, with all four threads. Workers end by themselves some minutes before
        # the limit, and other workers resume their parts.
        worker_extra_args=["--resources", "slot=1", "--lifetime", "230m", "--lifetime-stagger", "5m"],
    )
    cluster.adapt(minimum_jobs=1, maximum_jobs=given.jobs)
    progress = Progress()
    with cluster, Client(cluster) as client:
        print(f"dashboard: {client.dashboard_link}", file=sys.stderr)
        try:
            # As many parts are submitted as there may be workers, so that the cluster grows.
            summary = build(client, given.plan, given.store, given.output, slots=given.jobs, progress=progress)
        except CornicheError as error:
            print(error, file=sys.stderr)
            return error.exit_code
    print(summary.to_text())
    return 0


if __name__ == "__main__":
    sys.exit(main())
