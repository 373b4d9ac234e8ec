"""Sheets in stretches that are laid one by one, in any process."""

from __future__ import annotations

import json
import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import CASES

import spunlaid
from spunlaid import Case

SHORT = {"belt.distance": "0.1 m", "belt.speed": "5 m/s", "run.duration": "0.1 s", "run.spin_up": "10 ms", "air.lateral_cutoff": 4}


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A sheet that is longer than the one that is flown, so that it is laid in tiles."""
    place = tmp_path_factory.mktemp("web")
    (place / "short.toml").write_text(Case.read(CASES / "spunbond_slot.toml").with_(SHORT).to_toml())
    (place / "web.toml").write_text(
        """
        version = 1
        laydown.case = "short.toml"
        line = { filaments_per_metre = 1000, depth = "10 mm" }
        web = { width = "0.16 m", length = "2 m", cell = "2 mm", patches = ["4 mm", "10 mm"], flown = 150, window = "40 mm" }
        """
    )
    return place / "web.toml"


@pytest.fixture(scope="module")
def at_once(file: Path) -> spunlaid.Web:
    return spunlaid.web(file, threads=2)


@pytest.fixture(scope="module")
def flight(file: Path) -> spunlaid.WebFlight:
    return spunlaid.fly_web(file, threads=2)


def assert_same(one: spunlaid.Web, other: spunlaid.Web) -> None:
    np.testing.assert_array_equal(one.map, other.map)
    told = [json.loads(json.dumps(web.summary)) for web in (one, other)]
    for summary in told:
        # What it took.
        del summary["performance"]
    assert told[0] == told[1]
    assert one.notes == other.notes


@pytest.mark.parametrize("count", [1, 2, 3, 7])
def test_identical_from_any_number_of_pickled_stretches(
    flight: spunlaid.WebFlight, at_once: spunlaid.Web, count: int, tmp_path: Path
) -> None:
    stretches = pickle.loads(pickle.dumps(flight.stretches(count)))
    assert stretches[0].rows[0] == 0 and stretches[-1].rows[1] == 1000
    laid = pickle.loads(pickle.dumps([stretch.lay(threads=1) for stretch in reversed(stretches)]))
    joined = flight.join(laid, threads=2)
    assert_same(joined, at_once)
    if count == 7:
        # Single fibres of the window too.
        at_once.save(tmp_path / "one")
        joined.save(tmp_path / "other")
        assert (tmp_path / "one" / "fibres.vtp").read_bytes() == (tmp_path / "other" / "fibres.vtp").read_bytes()


def test_stretches_of_a_repeated_flight_fit(file: Path, flight: spunlaid.WebFlight, at_once: spunlaid.Web) -> None:
    again = spunlaid.fly_web(file, threads=1)
    first, second = flight.stretches(2)
    assert_same(again.join([first.lay(), again.stretches(2)[1].lay()]), at_once)
    other = spunlaid.fly_web(file, set={"web.seed": 5}, threads=2)
    with pytest.raises(ValueError, match="another flight"):
        other.join([first.lay(), second.lay()])


def test_rejects_missing_and_doubled_stretches(flight: spunlaid.WebFlight) -> None:
    laid = [stretch.lay() for stretch in flight.stretches(4)]
    with pytest.raises(spunlaid.CaseError, match="from 500 mm to 1 m is missing"):
        flight.join([laid[0], laid[3], laid[2]])
    with pytest.raises(spunlaid.CaseError, match="from 1 m to 1.5 m is in two stretches"):
        flight.join([*laid, laid[2]])
    with pytest.raises(TypeError, match="not Stretch"):
        flight.join(flight.stretches(1))  # type: ignore[arg-type]
    with pytest.raises(spunlaid.CaseError, match="ask for 1 to 1000"):
        flight.stretches(1001)


def test_rejects_webs_that_are_laid_at_once(file: Path) -> None:
    with pytest.raises(spunlaid.CaseError, match="independent"):
        spunlaid.fly_web(CASES / "web_known.toml")
    with pytest.raises(spunlaid.CaseError, match="all filaments of layer 1 fly"):
        spunlaid.fly_web(file, set={"web.flown": "all", "web.length": "0.1 m"})


def test_another_web_on_a_worker_is_seen(flight: spunlaid.WebFlight) -> None:
    (stretch,) = flight.stretches(1)
    text, cases, checksum = stretch.web
    object.__setattr__(stretch, "web", (text, cases, checksum ^ 1))
    with pytest.raises(spunlaid.ClusterError, match="another one on this machine"):
        stretch.lay()


def test_identical_on_a_cluster(file: Path, at_once: spunlaid.Web, tmp_path: Path) -> None:
    distributed: Any = pytest.importorskip("distributed")
    with (
        distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None, local_directory=tmp_path
        ) as cluster,
        distributed.Client(cluster) as client,
    ):
        assert_same(spunlaid.web(file, client=client), at_once)
        # Task by task, as the guide has it.
        flight = spunlaid.fly_web(file)
        laid = client.map(spunlaid.Stretch.lay, flight.stretches(4))
        assert_same(flight.join(client.gather(laid)), at_once)
    with pytest.raises(TypeError, match="dask"):
        spunlaid.web(file, client="tcp://localhost:8786")
