"""Studies on a cluster, with dask.distributed.

The client keeps the journal. It cuts what the journal lacks into bundles of whole flights, or of the webs of a point, hands out a few more of them
than the cluster has threads, and writes down what comes back before it hands out more. So neither it nor the scheduler
ever holds more than that, whatever the size of the study.
"""

from __future__ import annotations

import argparse
import pickle
import sys
import time
import zlib
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from . import _spunlaid
from ._errors import CaseError, ClusterError, Error, FileError, FolderError

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

_BUNDLE_S = 10.0
"""Computing time of a bundle [s], about: long beside the cost of a task, short beside the loss of a worker."""
_STEP_S = 17e-9
"""Computing time of an element, a step and a fibre [s], about; see docs/performance.md."""
_MOST_FLIGHTS = 64
_WIDTH = 8
_AHEAD = 3
"""Bundles handed out for each thread of the cluster."""
_LEAST_AHEAD = 16
_RETRIES = 3
"""How often a bundle that failed on a worker is tried again."""


def fly_bundle(packed: bytes, version: str) -> NDArray[np.float64]:
    """Flies a bundle; a worker calls it. The records of its fibres."""
    if version != _spunlaid.__version__:
        raise ClusterError(
            f"this worker has spunlaid {_spunlaid.__version__} and the client {version}; their numbers may differ in the last "
            "bits and are not mixed. Install the same version everywhere"
        )
    return _spunlaid.fly_bundle(*pickle.loads(zlib.decompress(packed)))


def fly(
    study: _spunlaid.Study,
    client: Any,
    show: Callable[[int, int], object] | None = None,
    *,
    flights: int | None = None,
) -> None:
    """Flies what the journal of a study lacks on the workers of a client.

    flights: number of flights of up to eight fibres in a task; by default about ten seconds of work
    """
    try:
        from distributed import Client
    except ImportError as error:
        raise ImportError('a cluster needs dask: pip install "spunlaid[dask]"') from error
    if not isinstance(client, Client):
        raise TypeError(f"client must be a dask.distributed.Client, not {type(client).__name__}")
    if client.asynchronous:
        raise TypeError("client must not be asynchronous; make it without asynchronous=True")
    if flights is None:
        flights = int(_BUNDLE_S / (_STEP_S * _WIDTH * max(study.work, 1.0)))
    flights = min(max(flights, 1), _MOST_FLIGHTS)
    while True:
        _round(study, client, show, flights)
        if not study.next_round():
            return


def _round(study: _spunlaid.Study, client: Any, show: Callable[[int, int], object] | None, flights: int) -> None:
    from distributed import as_completed

    left = iter(range(study.begin_round(flights)))
    done, of = study.fibres
    flying: Any = as_completed()
    under_way: set[Any] = set()
    ahead = _Ahead(client)

    def hand_out() -> None:
        while len(under_way) < ahead.count():
            number = next(left, None)
            if number is None:
                return
            packed = zlib.compress(pickle.dumps(study.bundle(number)), 1)
            future = client.submit(fly_bundle, packed, _spunlaid.__version__, pure=False, retries=_RETRIES)
            under_way.add(future)
            flying.add(future)

    try:
        hand_out()
        while under_way:
            future = next(flying)
            rows = _result(future)
            done += study.add(rows)
            under_way.discard(future)
            future.release()
            if show is not None:
                show(done, of)
            hand_out()
    finally:
        # After Ctrl-C or an error nobody waits for the others.
        client.cancel(list(under_way))


def _result(future: Any) -> NDArray[np.float64]:
    from distributed import KilledWorker

    try:
        return future.result()  # type: ignore[no-any-return]
    except KilledWorker as error:
        raise ClusterError(
            f"a bundle was lost with {_RETRIES} workers or more: {error}. Do they run out of memory? What was flown is kept; the "
            "same call goes on from there"
        ) from error
    except ImportError as error:
        raise ClusterError(f"a worker cannot import spunlaid ({error}); install it where the workers run") from error


class _Ahead:
    """How many bundles are handed out at once. Workers may join and leave."""

    def __init__(self, client: Any) -> None:
        self.client = client
        self.asked = -1e9
        self.threads = 0

    def count(self) -> int:
        now = time.monotonic()
        if now > self.asked + 2.0:
            self.threads, self.asked = sum(self.client.nthreads().values()), now
        return max(_AHEAD * self.threads, _LEAST_AHEAD)


def main(arguments: list[str] | None = None) -> int:
    """`spunlaid-dask`: a study on a cluster, from the command line."""
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
    from pathlib import Path

    from ._study import sweep

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
