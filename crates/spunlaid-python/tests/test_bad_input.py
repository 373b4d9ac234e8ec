"""Whatever is passed, an exception that says so is all that happens."""

from __future__ import annotations

import contextlib
import pickle
from typing import Any

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

import spunlaid
from spunlaid import _spunlaid

ALLOWED = (spunlaid.Error, TypeError, ValueError, KeyError, IndexError, OverflowError)
KEYS = sorted(spunlaid.keys())

anything = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=30) | st.binary(max_size=20),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=10), inner, max_size=4),
    max_leaves=8,
)
sizes = st.floats(allow_nan=True, allow_infinity=True) | st.sampled_from([0.0, -1.0, 1e-300, 1e300, 1e-6, 1e3])
texts = st.builds("{} {}".format, sizes, st.sampled_from(["m", "mm", "um", "m/s", "s", "ms", "Pa", "kg/m^3", "%", "parsec", ""]))
values = anything | sizes | texts | st.sampled_from(["auto", "taylor", "clamped", "leapfrog", "von-karman", "matsui", "nowhere.csv"])


@contextlib.contextmanager
def only_reported_errors() -> Any:
    with contextlib.suppress(*ALLOWED):
        yield


@settings(max_examples=400, deadline=None)
@given(st.dictionaries(st.sampled_from(KEYS) | st.text(max_size=20), values, max_size=4))
def test_cases(changes: dict[str, Any]) -> None:
    with only_reported_errors():
        case = spunlaid.Case.starter().with_(changes)
        assert spunlaid.Case.from_text(case.to_toml()) == case


@settings(max_examples=100, deadline=None)
@given(st.text(max_size=300) | st.just(spunlaid.Case.starter().to_toml()).flatmap(lambda t: st.integers(0, len(t)).map(lambda n: t[:n])))
def test_texts_of_cases(text: str) -> None:
    with only_reported_errors():
        spunlaid.Case.from_text(text)


@settings(max_examples=100, deadline=None)
@given(anything)
def test_dicts_studies_webs_and_records(value: Any) -> None:
    for function in (
        spunlaid.Case.from_dict,
        lambda value: spunlaid.sweep({"case": spunlaid.Case.starter(), **value} if isinstance(value, dict) else value),
        lambda value: spunlaid.sweep({"case": spunlaid.Case.starter(), "vary": value}),
        spunlaid.web,
        lambda value: spunlaid.analyse(value, 1e3),
        spunlaid.load,
        lambda value: _spunlaid.fly_bundle(value),
        lambda value: _spunlaid.read_table(value),
        lambda value: spunlaid.Flight(value),
    ):
        with only_reported_errors(), contextlib.suppress(OSError):
            function(value)


flight = spunlaid.Flight(spunlaid.Case.starter().with_({"run.duration": 0.01, "run.time_step": "20 us"}), 2)


@settings(max_examples=200, deadline=None)
@given(st.sampled_from(KEYS), values)
def test_changes_in_flight(key: str, value: Any) -> None:
    with only_reported_errors():
        flight.set(key, value)
    assert np.isfinite(flight.positions).all()


@settings(max_examples=60, deadline=None)
@given(st.binary(max_size=200), st.integers(0, 10**6))
def test_records_and_pickles_that_were_changed(extra: bytes, at: int) -> None:
    rows = np.frombuffer(extra[: len(extra) // 8 * 8])
    with only_reported_errors():
        spunlaid.analyse(np.concatenate([np.ones(80), rows]), 1e3)
    state = pickle.dumps(spunlaid.Case.starter())
    at %= len(state)
    text = state.replace(b"10 m/s", b"1\xff m/s") if at % 2 else state
    with only_reported_errors(), contextlib.suppress(pickle.UnpicklingError, UnicodeDecodeError):
        pickle.loads(text)
