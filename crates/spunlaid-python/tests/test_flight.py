"""Flights that Python steps."""

from __future__ import annotations

import pickle
import threading
from pathlib import Path

import numpy as np
import pytest

import spunlaid
from spunlaid import Case, Flight


def test_identical_to_a_run(short: Case) -> None:
    run = spunlaid.run(short, 11)
    flight = Flight(short, replicates=11)
    for instant, time in enumerate(run.end_node["time_s"][:-1]):
        flight.step_to(time)
        ends = flight.positions[:, -1, :]
        for axis, column in enumerate(("x_m", "y_m", "z_m")):
            np.testing.assert_array_equal(ends[:, axis], run.end_node[column][:, instant])
        np.testing.assert_array_equal(flight.energies["kinetic_j"], run.energy["kinetic_j"][:, instant])
    assert flight.velocities.shape == flight.positions.shape == (11, flight.tensions.shape[1] + 1, 3)


def test_times_may_have_units_and_cases_may_be_paths_or_dicts(short: Case, tmp_path: Path) -> None:
    (tmp_path / "case.toml").write_text(short.to_toml())
    flights = [Flight(case, 2) for case in (short, short.to_dict(), tmp_path / "case.toml", str(tmp_path / "case.toml"))]
    for flight, first, last in zip(flights, (0.002, "2 ms", "2000 us", np.float32(0.002)), (0.004, "4 ms", 4e-3, "0.004 s")):
        flight.step(first)
        flight.step_to(last)
        np.testing.assert_array_equal(flight.positions, flights[0].positions)
    for bad, error, words in (
        ("3 parsec", spunlaid.FlightError, "unknown unit"),
        ("3", spunlaid.FlightError, "no unit"),
        ("3 m", spunlaid.FlightError, "is a length"),
        (True, TypeError, "bool"),
        (None, TypeError, "NoneType"),
    ):
        with pytest.raises(error, match=words):
            flights[0].step(bad)  # type: ignore[arg-type]


def test_no_step_takes_a_fibre_apart(short: Case) -> None:
    flight = Flight(short)
    flight.step(0.01)
    lengths = np.linalg.norm(np.diff(flight.positions, axis=1), axis=2)
    # Neither does a tension of millinewtons stretch it by more than a thousandth.
    np.testing.assert_allclose(lengths, short["fibre.element_length"], rtol=1e-3)
    assert abs(flight.time - 0.01) < flight.time_step


def test_a_change_in_flight_counts_from_then_on(short: Case) -> None:
    still, faster = Flight(short, 4), Flight(short, 4)
    for flight in (still, faster):
        flight.step(0.005)
    np.testing.assert_array_equal(still.positions, faster.positions)
    faster.set("air.velocity", 30.0)
    np.testing.assert_array_equal(still.positions, faster.positions)
    for flight in (still, faster):
        flight.step(0.005)
    # Faster air draws the fibre tighter.
    assert np.all(faster.tensions[:, 0] > still.tensions[:, 0])
    same = Flight(short, 4)
    same.step(0.005)
    same.set("air.velocity", "30 m/s")
    same.step(0.005)
    np.testing.assert_array_equal(same.positions, faster.positions)


def test_a_fed_fibre_grows_and_lays(fed: Case) -> None:
    flight = Flight(fed, 3)
    flight.step(0.001)
    few = flight.positions.shape[1]
    flight.step(0.03)
    assert flight.positions.shape[1] > few
    laid = flight.take_laid()
    assert len(laid) == 3 and all(len(of["s_m"]) > 0 for of in laid)
    assert all(len(of["s_m"]) == 0 for of in flight.take_laid())


def test_refusals_leave_the_flight_as_it_is(short: Case) -> None:
    flight = Flight(short, 2)
    flight.step(0.002)
    before = flight.positions
    for key, value, error in [
        ("run.duration", 3.0, spunlaid.FlightError),
        ("air.velocty", 3.0, spunlaid.CaseError),
        ("air.velocity", "20 parsec", spunlaid.CaseError),
        ("air.velocity", float("nan"), spunlaid.CaseError),
        ("air.velocity", None, TypeError),
        ("air.velocity", True, TypeError),
        ("air.velocity", "\ud800", ValueError),
    ]:
        with pytest.raises(error):
            flight.set(key, value)  # type: ignore[arg-type]
    for time in (0.0, float("nan"), float("inf"), -1.0):
        with pytest.raises(spunlaid.FlightError):
            flight.step_to(time)
    np.testing.assert_array_equal(flight.positions, before)
    for replicates in (0, 5000):
        with pytest.raises(ValueError, match="replicates"):
            Flight(short, replicates)
    with pytest.raises(spunlaid.FlightError, match="pickled"):
        pickle.dumps(flight)


def test_threads_may_share_a_flight(short: Case) -> None:
    flight, alone = Flight(short, 8), Flight(short, 8)
    alone.step_to(0.012)
    errors: list[BaseException] = []

    def look() -> None:
        try:
            for _ in range(20):
                assert np.isfinite(flight.positions).all()
        except BaseException as error:
            errors.append(error)

    threads = [threading.Thread(target=look) for _ in range(3)]
    for thread in threads:
        thread.start()
    for millisecond in range(1, 13):
        flight.step_to(millisecond * 1e-3)
    for thread in threads:
        thread.join()
    assert not errors
    np.testing.assert_array_equal(flight.positions, alone.positions)
