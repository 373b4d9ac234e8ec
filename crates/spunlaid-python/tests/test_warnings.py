"""What the program prints as a warning, tables of other packages, and limits of the system."""

from __future__ import annotations

import pickle
import threading
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import spunlaid
from spunlaid import Case, SpunlaidWarning

from conftest import CASES


def warnings_of(work: Any) -> list[SpunlaidWarning]:
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        work()
    found = [warning for warning in caught if issubclass(warning.category, SpunlaidWarning)]
    # Each points to the line that has called the package.
    assert all(warning.filename == __file__ for warning in found)
    return [warning.message for warning in found]  # type: ignore[misc]


def test_each_function_warns_of_what_the_program_warns_of(short: Case, tmp_path: Path) -> None:
    key = "air.turbulence_intensity"
    gusty = short.with_({key: 1.2, "run.time_step": None})
    said = warnings_of(lambda: spunlaid.run(gusty))
    assert any(warning.key == key for warning in said), said
    assert any(warning.key == key for warning in warnings_of(lambda: spunlaid.Air(gusty.with_({"air.lateral": "von-karman"}))))
    study = {"case": gusty, "vary": {"air.velocity": [5, 10]}, "replicates": 2}
    assert any(warning.key == key for warning in warnings_of(lambda: spunlaid.sweep(study)))
    web = lambda: spunlaid.web(CASES / "web_known.toml", set={"line.belt_speed": "20 m/s", "web.length": "0.2 m"})  # noqa: E731
    assert any(warning.key == "line.basis_weight" for warning in warnings_of(web))
    line = lambda: spunlaid.spin(CASES / "spinline.toml", set={"spinline.length": "40 m"})  # noqa: E731
    assert any(str(warning.key).startswith("spinline") for warning in warnings_of(line))
    # A record of a few integral times.
    record = np.random.default_rng(1).normal(10.0, 1.0, 500)
    assert warnings_of(lambda: spunlaid.analyse(record, rate="1 kHz"))
    assert pickle.loads(pickle.dumps(said[0])).key == said[0].key


def test_a_run_outside_its_field_warns(tmp_path: Path) -> None:
    rows = [f"{x},{y},{z},10,0,0" for z in (0, 1) for y in (0, 1) for x in (0, 1)]
    (tmp_path / "field.csv").write_text("x_m,y_m,z_m,u_m_s,v_m_s,w_m_s\n" + "\n".join(rows))
    case = Case.starter().with_({"run.duration": 0.01, "run.replicates": 2, "run.checks": "none"})
    air = {"air": {"field": tmp_path / "field.csv", "cutoff_frequency": 100.0, "turbulence_intensity": 0.1, "length_scale": 0.05}}
    far = {name: value for name, value in dict(case).items() if not name.startswith("air.")}
    made = Case.from_dict({**far, **air, "air.field_root": ["0.9 m", "0.5 m", "0.5 m"]})
    said = warnings_of(lambda: spunlaid.run(made))
    assert any("outside the region where the flow is known" in str(warning) for warning in said), said
    within, beyond = ([0.5, 0.5, 0.5], [9.0, 0.0, 0.0])
    assert len(warnings_of(lambda: made.air_at([within, beyond]))) == len(warnings_of(lambda: made.air_at([within]))) + 1


def test_frames_are_arrays_and_columns_are_values(short: Case) -> None:
    places = np.array([[0.1, 0.0, 0.0], [0.2, 0.0, 0.0]])
    wanted = short.air_at(places)["u_m_s"]
    pandas, polars = pytest.importorskip("pandas"), pytest.importorskip("polars")
    for frame in (pandas.DataFrame(places, columns=["x", "y", "z"]), polars.DataFrame(places, schema=["x", "y", "z"])):
        np.testing.assert_array_equal(short.air_at(frame)["u_m_s"], wanted)
    means = []
    for values in ([5.0, 10.0], pandas.Series([5.0, 10.0]), polars.Series([5.0, 10.0]), np.array([5.0, 10.0])):
        study = spunlaid.sweep({"case": short, "vary": {"air.velocity": values}, "replicates": 2})
        means.append(study.mean["amplitude_y_m"])
    assert all((mean == means[0]).all() for mean in means)
    with pytest.raises(ValueError, match="three coordinates"):
        short.air_at(pandas.DataFrame({"x": [1.0]}))


def test_booleans_of_numpy_are_booleans(short: Case) -> None:
    for flag in (True, np.True_, np.array(True)):
        with pytest.raises(spunlaid.CaseError):
            short.with_({"air.velocity": flag})
    lines = [spunlaid.spin(CASES / "spinline.toml", set={"spinline.field": flag}) for flag in (False, np.False_)]
    assert lines[0].final_diameter_m == lines[1].final_diameter_m


def test_two_threads_step_a_flight_by_both_their_times(short: Case) -> None:
    flight, errors = spunlaid.Flight(short, replicates=2), []

    def step() -> None:
        for _ in range(20):
            try:
                flight.step("1 ms")
            except spunlaid.Error as error:
                errors.append(error)

    threads = [threading.Thread(target=step) for _ in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not errors
    assert flight.time == pytest.approx(0.04, abs=1e-9)


def test_kept_runs_hold_no_files(short: Case) -> None:
    files = Path("/proc/self/fd")
    if not files.exists():
        pytest.skip("this system does not list open files")
    # Shapes that go to a file.
    long = short.with_({"run.duration": 0.4, "run.output_interval": "0.1 ms", "run.replicates": 2, "run.checks": "none"})
    runs, before = [], len(list(files.iterdir()))
    for seed in (1, 2, 3):
        runs.append(spunlaid.run(long, seed=seed))
        assert len(list(files.iterdir())) <= before
    assert runs[0].shapes.positions_m.shape[:2] == (2, len(runs[0].shapes.time_s))
    assert np.isfinite(runs[0].shapes.positions_m).all()


def test_results_of_each_kind_are_loaded_and_pickled(short: Case, tmp_path: Path) -> None:
    line = spunlaid.spin(CASES / "spinline.toml")
    line.save(tmp_path / "line")
    for again in (spunlaid.load(tmp_path / "line"), pickle.loads(pickle.dumps(line))):
        assert again.measures == line.measures and again.text and again.final_diameter_m == line.final_diameter_m
        for column, values in line.stations.items():
            np.testing.assert_array_equal(again.stations[column], values)
    study = spunlaid.sweep({"case": short, "vary": {"air.velocity": [5.0, 10.0]}, "replicates": 2})
    study.save(tmp_path / "study")
    for again in (spunlaid.load(tmp_path / "study"), pickle.loads(pickle.dumps(study))):
        assert again.factors == study.factors and len(again) == 2
        for column, values in study.mean.items():
            np.testing.assert_array_equal(again.mean[column], values)
        assert pickle.loads(pickle.dumps(again)).mean.keys() == study.mean.keys()
    web = spunlaid.web(CASES / "web_known.toml", set={"web.length": "0.2 m", "web.width": "0.2 m"})
    web.save(tmp_path / "web")
    again = spunlaid.load(tmp_path / "web")
    assert isinstance(again, spunlaid.Web)
    np.testing.assert_allclose(again.map, web.map, rtol=1e-6)
    np.testing.assert_array_equal(again.patches["cv"], web.patches["cv"])
    with pytest.raises(spunlaid.FolderError):
        spunlaid.load(tmp_path)


def test_words_that_are_no_dict_say_what_to_write(short: Case) -> None:
    for work in (
        lambda: spunlaid.run(short, set="air.velocity=1"),  # type: ignore[arg-type]
        lambda: spunlaid.web(CASES / "web_known.toml", set="web.length=1"),  # type: ignore[arg-type]
        lambda: spunlaid.spin(CASES / "spinline.toml", set="a=1"),  # type: ignore[arg-type]
    ):
        with pytest.raises(TypeError, match="set takes a dict"):
            work()
    with pytest.raises(ValueError, match="frequency"):
        spunlaid.analyse(np.ones(500), rate="1 km")
