"""Studies on a cluster with dask.distributed.

The client keeps the journal. It cuts what the journal lacks into bundles of whole flights, or of the webs of a point, hands out a few more of them
than the cluster has threads, and writes down what comes back before it hands out more. So neither it nor the scheduler
ever holds more than that, whatever the size of the study. A worker computes one web in shared turbulence at a time, with all its threads.
"""

from __future__ import annotations

import pickle
import time
import zlib
from collections.abc import Callable
from concurrent.futures import CancelledError
from queue import Empty, SimpleQueue
from typing import Any

from . import _spunlaid
from ._errors import ClusterError
from ._optional import needed

_BUNDLE_S = 10.0
"""Computing time of a bundle [s], about: long against the cost of a task, short against the loss of a worker."""
_STEP_S = 17e-9
"""Computing time of an element, a step and a fibre [s], about."""
_MOST_FLIGHTS = 64
_WIDTH = 8
_AHEAD = 3
"""Bundles handed out for each thread of the cluster."""
_LEAST_AHEAD = 16
_LOOK_S = 2.0
"""Time between two looks whether workers have joined [s]."""
_RETRIES = 3
"""How often a bundle that failed on a worker is tried again."""


def check_client(client: Any) -> None:
    """Raises TypeError for what is no client of a cluster."""
    if not isinstance(client, needed("distributed", "dask", "a cluster").Client):
        raise TypeError(f"client must be a dask.distributed.Client, not {type(client).__name__}")
    if client.asynchronous:
        raise TypeError("client must not be asynchronous; make it without asynchronous=True")


def _check_version(version: str) -> None:
    if version != _spunlaid.__version__:
        raise ClusterError(
            f"this worker has spunlaid {_spunlaid.__version__} and the client {version}; their numbers may differ in the last "
            "bits and are not mixed. Install the same version everywhere"
        )


def fly_bundle(packed: bytes, version: str, all_threads: bool) -> list[Any]:
    """Flies a bundle; a worker calls it. The records of its fibres."""
    from distributed import get_worker

    _check_version(version)
    threads = get_worker().state.nthreads if all_threads else 1
    parts, sides = pickle.loads(zlib.decompress(packed))
    return _spunlaid.fly_bundle(parts, sides, threads)


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
    check_client(client)
    if flights is None:
        flights = int(_BUNDLE_S / (_STEP_S * _WIDTH * max(study.work, 1.0)))
    flights = min(max(flights, 1), _MOST_FLIGHTS)
    while True:
        _round(study, client, show, flights)
        if not study.next_round():
            return


def _round(study: _spunlaid.Study, client: Any, show: Callable[[int, int], object] | None, flights: int) -> None:
    left = iter(range(study.begin_round(flights)))
    done, of = study.fibres
    finished: SimpleQueue[Any] = SimpleQueue()
    under_way: set[Any] = set()
    one_each = study.one_web_a_machine
    ahead = _Ahead(client, one_each)

    def hand_out() -> None:
        while len(under_way) < ahead.count():
            number = next(left, None)
            if number is None:
                return
            packed = zlib.compress(pickle.dumps(study.bundle(number)), 1)
            future = client.submit(fly_bundle, packed, _spunlaid.__version__, one_each, pure=False, retries=_RETRIES)
            under_way.add(future)
            future.add_done_callback(finished.put)

    try:
        hand_out()
        while under_way:
            try:
                future = finished.get(timeout=_LOOK_S)
            except Empty:
                # A worker may have joined.
                hand_out()
                continue
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


def _result(future: Any) -> list[Any]:
    from distributed import KilledWorker

    try:
        return future.result()  # type: ignore[no-any-return]
    except KilledWorker as error:
        raise ClusterError(
            f"a bundle was lost with {_RETRIES} workers or more: {error}. Do they run out of memory? What was computed of a "
            "study is kept; the same call goes on from there"
        ) from error
    except CancelledError as error:
        raise ClusterError(
            f"a bundle was cancelled on the cluster ({error or 'the scheduler was restarted or closed'}). What was computed of a "
            "study is kept; the same call goes on from there"
        ) from error
    except ImportError as error:
        raise ClusterError(f"a worker cannot import spunlaid ({error}); install it where the workers run") from error


class _Ahead:
    """How many bundles are handed out at once. Workers may join and leave.

    one_each: whether each worker has one at a time
    """

    def __init__(self, client: Any, one_each: bool) -> None:
        self.client = client
        self.one_each = one_each
        self.asked = -1e9
        self.threads: list[int] = []

    def count(self) -> int:
        now = time.monotonic()
        if now > self.asked + _LOOK_S:
            self.threads, self.asked = list(self.client.nthreads().values()), now
        if self.one_each:
            return max(len(self.threads), 1)
        return max(_AHEAD * sum(self.threads), _LEAST_AHEAD)
