"""The air of a case, looked at."""

from __future__ import annotations

import numpy as np
import pytest

import spunlaid
from spunlaid import Air, Case


@pytest.fixture
def shared(short: Case) -> Case:
    return short.with_({"air.lateral": "von-karman", "air.lateral_cutoff": 6, "air.eddies": "convected"})



def test_times_and_places_are_broadcast(shared: Case) -> None:
    air = Air(shared)
    y, z = air.extent
    v = air.at(np.array([0.0, 0.1])[:, None], 0.1, np.linspace(0, y, 3, endpoint=False), 0.3 * z)
    assert v.shape == (2, 3, 3)
    np.testing.assert_array_equal(v[1, 2], air.at(0.1, 0.1, 2 * y / 3, 0.3 * z))


def test_does_not_depend_on_the_order(shared: Case) -> None:
    t = np.array([0.3, 0.0, 0.7, 0.3])
    all_at_once = Air(shared).at(t, 0.1, 0.0, 0.0)
    air = Air(shared)
    for time, velocity in zip(t, all_at_once):
        np.testing.assert_array_equal(air.at(time, 0.1, 0.0, 0.0), velocity)
    assert (Air(shared, replicate=2).at(0.3, 0.1, 0.0, 0.0) != all_at_once[0]).any()
    assert (Air(shared, seed=99).at(0.3, 0.1, 0.0, 0.0) != all_at_once[0]).any()


def test_refuses_what_it_does_not_know(shared: Case, short: Case) -> None:
    with pytest.raises(spunlaid.FlightError, match="von-karman"):
        Air(short)
    with pytest.raises(ValueError, match="replicate"):
        Air(shared, replicate=0)
    air = Air(shared)
    for t, x in ((-1.0, 0.0), (np.nan, 0.0), (0.0, np.inf)):
        with pytest.raises(spunlaid.FlightError):
            air.at(t, x, 0.0, 0.0)
    with pytest.raises(ValueError):
        air.at([0.0, 1.0], [0.0, 1.0, 2.0], 0.0, 0.0)
    assert air.at([], 0.0, 0.0, 0.0).shape == (0, 3)


def test_reports_the_air_at_places(short: Case) -> None:
    places = np.array([[0.0, 0.0, 0.0], [0.1, -0.02, 5.0]])
    found = short.air_at(places)
    speed, rms = short["air.velocity"], short["air.velocity"] * short["air.turbulence_intensity"]
    np.testing.assert_array_equal(np.stack([found[name] for name in ("x_m", "y_m", "z_m")], axis=1), places)
    np.testing.assert_allclose(found["u_m_s"], speed)
    np.testing.assert_allclose(found["k_m2_s2"], 1.5 * rms**2)
    np.testing.assert_array_equal(found["cutoff_frequency_hz"], short["air.cutoff_frequency"])
    with pytest.raises(spunlaid.FlightError, match="not a CFD field"):
        short.air_at(places, axes="field")
    for wrong in ([0.0, 1.0, 2.0], [[0.0, 1.0]], "places"):
        with pytest.raises(ValueError, match="three coordinates"):
            short.air_at(wrong)
    with pytest.raises(ValueError, match="axes"):
        short.air_at(places, axes="belt")  # type: ignore[arg-type]
