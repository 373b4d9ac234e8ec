"""Studies on a cluster of processes, of which some are killed."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

import spunlaid
from spunlaid import Case, _dask

distributed = pytest.importorskip("distributed")

TABLES = ("results.csv", "results.parquet", "replicates.parquet", "results.json")


@pytest.fixture(scope="module")
def study() -> dict[str, object]:
    """Twelve points of 24 fibres, in two groups that cannot fly together."""
    short = {"run.duration": 0.05, "run.time_step": "10 us", "run.output_interval": "1 ms", "run.spin_up": 0}
    case = Case.starter().with_(short)
    vary = {"air.velocity": [5.0, 8.0, 10.0, 12.0, 15.0, 20.0], "fibre.element_length": ["50 mm", "25 mm"]}
    return {"case": case, "replicates": 23, "vary": vary}


@pytest.fixture(scope="module")
def alone(study: dict[str, object], tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of the study, simulated on this machine."""
    out = tmp_path_factory.mktemp("alone") / "s"
    spunlaid.sweep(study, out=out)
    return out


@pytest.fixture(scope="module")
def client(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Any]:
    """The client of a cluster of two workers."""
    place = tmp_path_factory.mktemp("cluster")
    with (
        distributed.LocalCluster(
            n_workers=2, threads_per_worker=3, processes=True, dashboard_address=None, local_directory=place
        ) as cluster,
        distributed.Client(cluster) as client,
    ):
        yield client


@pytest.fixture
def cluster(client: Any) -> Any:
    """The same, once a worker that was killed is there again."""
    client.wait_for_workers(2)
    return client


def assert_same(one: Path, other: Path) -> None:
    for table in TABLES:
        assert (one / table).read_bytes() == (other / table).read_bytes(), table


def test_identical_with_a_worker_killed_half_way(
    study: dict[str, object], alone: Path, cluster: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("spunlaid._dask._MOST_FLIGHTS", 1)
    pids = cluster.run(os.getpid)
    killed: list[int] = []

    def kill(done: int, of: int) -> None:
        if done > of / 3 and not killed:
            killed.append(next(iter(pids.values())))
            os.kill(killed[0], signal.SIGKILL)

    found = spunlaid.sweep(study, client=cluster, out=tmp_path / "s", progress=kill)
    assert killed and (found.n == 23).all()
    assert_same(alone, tmp_path / "s")


def test_identical_webs_on_a_cluster(cluster: Any, tmp_path: Path) -> None:
    """Webs of known numbers, and webs whose case is simulated by each worker."""
    cases = Path(__file__).parents[3] / "cases"
    known = {
        "web": cases / "web_known.toml",
        "replicates": 2,
        "set": {"web.width": "0.1 m", "web.length": "0.1 m", "laydown.sigma_md": "10 mm", "laydown.sigma_cd": "10 mm"},
        "vary": {"line.belt_speed": [3.0, 4.0]},
    }
    short = {"belt.distance": "0.1 m", "run.duration": "0.1 s", "run.spin_up": "10 ms", "run.replicates": 3}
    (tmp_path / "short.toml").write_text(Case.read(cases / "spunbond.toml").with_(short).to_toml())
    web = tmp_path / "web.toml"
    web.write_text(
        """
        version = 1
        laydown.case = "short.toml"
        line.rows = [{ offset = "0 mm", pitch = "4 mm", filaments = 25 }]
        web.width = "0.1 m"
        web.length = "60 mm"
        """
    )
    simulated = {"web": web, "vary": {"belt.speed": [3.0, 4.0]}}
    for number, study in enumerate((known, simulated)):
        here, there = (tmp_path / f"{where}{number}" for where in ("here", "there"))
        spunlaid.sweep(study, out=here)
        found = spunlaid.sweep(study, client=cluster, out=there)
        assert_same(here, there)
        assert found.noun == "web" and (found.mean["cv_10_mm"] > 0.0).all()


def test_each_worker_has_one_web_in_one_air(cluster: Any, tmp_path: Path) -> None:
    cases = Path(__file__).parents[3] / "cases"
    short = {"belt.distance": "0.1 m", "run.duration": "0.1 s", "run.spin_up": "10 ms", "fibre.element_length": "10 mm"}
    eddies = {"air.lateral": "von-karman", "air.lateral_cutoff": 6}
    (tmp_path / "short.toml").write_text(Case.read(cases / "spunbond.toml").with_(short | eddies).to_toml())
    (tmp_path / "web.toml").write_text(
        """
        version = 1
        laydown.case = "short.toml"
        line = { filaments_per_metre = 100, slot_gap = "10 mm" }
        web = { width = "0.1 m", length = "40 mm", patches = ["2 mm", "5 mm"] }
        """
    )
    study = {"web": tmp_path / "web.toml", "replicates": 2, "vary": {"line.slot_gap": ["0 mm", "5 mm"]}}
    most: list[int] = []

    def look(done: int, of: int) -> None:
        most.append(max(len(tasks) for tasks in cluster.processing().values()))

    found = spunlaid.sweep(study, client=cluster, out=tmp_path / "there", progress=look)
    # A web is a bundle, though six threads could have taken all of them.
    assert len(most) == 4 and max(most) <= 1
    spunlaid.sweep(study, out=tmp_path / "here")
    assert_same(tmp_path / "here", tmp_path / "there")
    assert (found.n == 2).all() and found.mean["cv_5_mm"][0] != found.mean["cv_5_mm"][1]


def test_rounds_are_those_of_one_machine(cluster: Any, short: Case) -> None:
    """Without a folder, too."""
    until = {"at_least": 6, "at_most": 64, "until": {"amplitude_y": "15 %"}}
    study = {"case": short, "replicates": until, "vary": {"air.velocity": [5.0, 10.0, 20.0]}}
    here, there = spunlaid.sweep(study), spunlaid.sweep(study, client=cluster)
    assert here.to_pandas().equals(there.to_pandas()) and here.n.max() > 6


def test_what_a_killed_client_left_goes_on(
    study: dict[str, object], alone: Path, cluster: Any, program: Path, tmp_path: Path
) -> None:
    out = tmp_path / "s"
    # The text of the study stands in the folder of the first one.
    path = alone / "study.toml"
    # Small bundles, so that there is something to lose.
    code = "import sys; from spunlaid import _cluster, _dask; _dask._MOST_FLIGHTS = 1; sys.exit(_cluster.main())"
    command = [sys.executable, "-c", code, str(path), "--scheduler", cluster.scheduler.address, "--out", str(out)]
    client = subprocess.Popen(command, stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
    journal = out / "journal"
    header = 200
    while not (journal.exists() and journal.stat().st_size > header + 8 * 200):
        assert client.poll() is None, "the client is still at work"
        time.sleep(0.01)
    client.kill()
    client.wait()
    assert not (out / "results.csv").exists()
    left = journal.stat().st_size
    # The program goes on with what the cluster has begun; and is stopped, too.
    sweep = subprocess.Popen([program, "sweep", path, "--out", out, "--threads", "1"], stderr=subprocess.DEVNULL)
    while journal.stat().st_size <= left:
        assert sweep.poll() is None, "the sweep is still at work"
        time.sleep(0.005)
    sweep.send_signal(signal.SIGINT)
    assert sweep.wait() == 130
    # And the cluster with what the program has left.
    finished = subprocess.run(command, capture_output=True, text=True, check=True)
    assert "276 fibres at 12 points" in finished.stdout
    assert_same(alone, out)


def test_a_cancelled_sweep_leaves_no_work_behind(study: dict[str, object], cluster: Any, tmp_path: Path) -> None:
    class Enough(Exception):
        pass

    def stop(done: int, of: int) -> None:
        raise Enough

    with pytest.raises(Enough):
        spunlaid.sweep(study, client=cluster, out=tmp_path / "s", progress=stop)
    for _ in range(200):
        if not cluster.processing() or not any(cluster.processing().values()):
            break
        time.sleep(0.05)
    assert not any(cluster.processing().values())


def test_other_content_of_a_file_on_a_worker_is_seen(cluster: Any) -> None:
    from spunlaid import _spunlaid

    text = 'case = "case.toml"\ndesign = "grid"\nreplicates = 1\n[vary]\n"air.velocity" = ["10 m/s"]\n'
    study = _spunlaid.Study(text, Case.starter())
    study.begin_round(1)
    (part,), sides = study.bundle(0)
    with pytest.raises(spunlaid.ClusterError, match="another one on this machine"):
        _spunlaid.fly_bundle([{**part, "checksum": part["checksum"] ^ 1}], sides)


def test_a_bundle_that_others_cancel_is_an_error_with_the_way_on(cluster: Any) -> None:
    future = cluster.submit(time.sleep, 60)
    cluster.cancel([future], force=True)
    with pytest.raises(spunlaid.ClusterError, match="cancelled on the cluster .* the same call goes on"):
        _dask._result(future)


def test_rejects_what_is_no_client(study: dict[str, object]) -> None:
    with pytest.raises(TypeError, match="dask"):
        spunlaid.sweep(study, client="tcp://localhost:8786")


def test_the_command_reports_what_is_wrong(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    from spunlaid._cluster import main

    with distributed.LocalCluster(n_workers=0, processes=False, dashboard_address=None) as cluster:
        address = cluster.scheduler_address
        thread = threading.current_thread()
        assert main([str(tmp_path / "no.toml"), "--scheduler", address, "--quiet"]) == 1 and thread.is_alive()
    assert "there is no such file" in capsys.readouterr().err
