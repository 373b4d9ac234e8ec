"""`spunlaid-dask`: a study on a cluster, from the command line."""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

from . import _spunlaid
from ._errors import CaseError, ClusterError, Error, FileError, FolderError
from ._study import sweep


def main(arguments: list[str] | None = None) -> int:
    """Runs the command; returns its exit code."""
    parser = argparse.ArgumentParser(
        prog="spunlaid-dask",
        description="Flies a study on the workers of a Dask scheduler, and writes the folder that `spunlaid sweep` writes. "
        "If it is stopped, the same command goes on.",
    )
    parser.add_argument("study", help="the study file")
    where = parser.add_mutually_exclusive_group(required=True)
    where.add_argument("--scheduler", metavar="ADDRESS", help="address of the scheduler, tcp://host:8786")
    where.add_argument("--scheduler-file", metavar="FILE", help="file that the scheduler has written")
    parser.add_argument("--out", metavar="FOLDER", help="folder for the results; results/STUDY by default")
    parser.add_argument("--force", action="store_true", help="replace other results in the folder")
    parser.add_argument("--points", type=int, metavar="N", help="number of points, which more than 10,000 need")
    parser.add_argument("--replicates", type=int, metavar="N", help="fibres per point")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help='a key for all points: run.duration="2 s"')
    parser.add_argument("--quiet", action="store_true", help="no progress")
    parser.add_argument("--version", action="version", version=f"spunlaid {_spunlaid.__version__}")
    asked = parser.parse_args(arguments)
    try:
        return _main(asked)
    except KeyboardInterrupt:
        print("stopped; the same command goes on", file=sys.stderr)
        return 130
    except (CaseError, FileError, FolderError, ValueError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    except (Error, OSError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 2


def _main(asked: argparse.Namespace) -> int:
    changes: dict[str, str] = {}
    for text in asked.set:
        key, equals, value = text.partition("=")
        if not equals:
            raise ValueError(f"--set {text}: write a key and a value, run.duration=\"2 s\"")
        changes[key.strip()] = value.strip()
    out = asked.out or Path("results") / Path(asked.study).stem
    try:
        from distributed import Client
    except ImportError:
        raise ClusterError('a cluster needs dask: pip install "spunlaid[dask]"') from None
    began = last = time.monotonic()

    def show(done: int, of: int) -> None:
        nonlocal last
        now = time.monotonic()
        if not asked.quiet and (now - last > 5.0 or done == of):
            last = now
            print(f"replicates {done}/{of} after {now - began:.0f} s", file=sys.stderr)

    with Client(asked.scheduler, scheduler_file=asked.scheduler_file) as client:
        if not asked.quiet:
            print(f"workers: {len(client.nthreads())}, dashboard: {client.dashboard_link}", file=sys.stderr)
        study = sweep(
            asked.study,
            client=client,
            out=out,
            force=asked.force,
            points=asked.points,
            replicates=asked.replicates,
            set=changes,
            progress=show,
        )
    print(f"{int(study.n.sum())} {study.noun}s at {len(study)} points\nopen {Path(out) / 'report.html'}")
    lost = int(study.lost.sum())
    if lost:
        print(f"error: {lost} fibres were lost: the computation diverged, or the fibre did not reach the belt", file=sys.stderr)
        return 2
    return 0
