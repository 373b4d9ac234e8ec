"""Cases: read, changed, compared, pickled; and what is wrong with them."""

from __future__ import annotations

import pickle
import subprocess
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pytest
from conftest import CASES

import spunlaid
from spunlaid import Case, CaseError

CYLINDERS = CASES.parent / "crates/spunlaid-results/assets/published/cylinders.csv"

# Webs and spinlines alone are no cases.
OTHERS = ("web", "whole_line.", "spinline", "melt_spinning")
ALL = sorted(path for path in CASES.glob("*.toml") if not path.name.startswith(OTHERS))


@pytest.mark.parametrize("path", ALL, ids=lambda path: path.stem)
def test_identical_through_text_dict_and_pickle(path: Path) -> None:
    case = Case.read(path)
    assert Case.from_text(case.to_toml()) == case
    again = pickle.loads(pickle.dumps(case))
    assert again == case and again.to_toml().count("\n") == case.to_toml().count("\n")
    assert Case.from_dict(case.to_dict()) == case


def test_numbers_are_in_si_units_and_texts_have_units() -> None:
    case = Case.starter()
    changed = case.with_({"air.velocity": "20 m/s", "fibre.diameter": 18e-6})
    assert (changed["air.velocity"], changed["fibre.diameter"]) == (20.0, 18e-6)
    assert case["air.velocity"] == 10.0, "the first case stays what it was"
    for same in (
        {"air": {"velocity": 20}, "fibre": {"diameter": "18 um"}},
        {"air.velocity": np.float32(20.0), "fibre.diameter": np.float64(18e-6)},
        {"air.velocity": np.array(20), "fibre.diameter": "0.018 mm"},
    ):
        assert case.with_(same) == changed
    # Without a value the default applies.
    damped = changed.with_({"run.damping": 3.0})
    assert damped != changed and damped.with_({"run.damping": None}) == changed


def test_a_case_is_a_mapping_of_its_keys() -> None:
    case = Case.starter()
    assert isinstance(case, Mapping) and len(case) == len(dict(case)) == len(list(case.items()))
    assert Case.from_dict(dict(case)) == Case.from_dict(case) == case
    assert case.keys() >= {"air.velocity", "fibre.diameter"} and 10.0 in case.values()
    nested = [f"{table}.{key}" for table, keys in case.to_dict().items() for key in keys]
    assert list(case) == nested
    # A known key without a meaning for this case is None; it is not one of its keys.
    assert case["feed.speed"] is None and "feed.speed" not in case and case.get("feed.speed", 3.0) == 3.0
    assert case.get("air.velocty") is None and case.get("air.velocity", 3.0) == 10.0 and 3 not in case
    record = Case.read(CASES / "record.toml")
    assert "air.record" in record and Case.from_dict(dict(record)) == record


def test_what_follows_from_a_key_follows_anew() -> None:
    # By Taylor's hypothesis the cut-off is the velocity over four length scales.
    case = Case.starter().with_({"air.cutoff_frequency": "taylor", "air.length_scale": 0.05})
    assert case.with_({"air.velocity": 30}).with_({"air.velocity": 40})["air.cutoff_frequency"] == 40 / (4 * 0.05)


def test_vectors_lists_and_paths() -> None:
    case = Case.starter().with_({"fibre.direction": [0, 3, 4]})
    assert case["fibre.direction"] == (0.0, 0.6, 0.8)
    record = Case.read(CASES / "record.toml")
    moved = record.with_({"air.record": CASES / "records" / "probe.csv"})
    assert moved == record


def test_the_file_is_named_with_line_key_and_remedy(tmp_path: Path) -> None:
    path = tmp_path / "bad.toml"
    text = Case.starter().to_toml().replace('velocity = "10 m/s"', 'velocity = "10 parsec"')
    path.write_text(text)
    with pytest.raises(CaseError) as caught:
        Case.read(path)
    error = caught.value
    line = 1 + text[: text.index("10 parsec")].count("\n")
    assert (error.key, error.line, error.file) == ("air.velocity", line, str(path))
    assert error.value == '"10 parsec"' and error.remedy is not None and "m/s" in error.remedy
    assert str(error).startswith(f"{path}:{line}: air.velocity")
    again = pickle.loads(pickle.dumps(error))
    assert (str(again), again.problems) == (str(error), error.problems)


def test_every_problem_is_listed() -> None:
    with pytest.raises(CaseError) as caught:
        Case.starter().with_({"fibre.diameter": -1.0, "air.velocty": 3, "run.time_step": "1 s", "air.density": float("nan")})
    assert {"fibre.diameter", "air.velocty", "air.density"} <= {problem.key for problem in caught.value.problems}
    assert "air.velocity" in str(caught.value), "the message suggests the right name"


@pytest.mark.parametrize(
    ("name", "changes"),
    [
        ("table1", {"run.time_step": "1 s"}),
        ("table1", {"fibre.diameter": "2 m", "run.duration": "1e9 s"}),
        ("table1", {"air.velocity": "400 m/s", "drag.along": "sakiadis"}),
        ("table1", {"feed.speed": "40 m/s"}),
        ("table1", {"drag.across": str(CYLINDERS), "fibre.diameter": "1 um"}),
        ("spunbond", {"belt.speed": "2 m/s", "run.replicates": "300"}),
        ("spunbond", {"air.turbulence_intensity": "20 %", "belt.distance": "9 mm"}),
        ("whole_line_fibre", {"spinline.throughput": "20 g/min"}),
    ],
)
def test_identical_checks_of_with_and_of_the_program(name: str, changes: dict[str, str], program: Path) -> None:
    path = CASES / f"{name}.toml"
    command = [program, "check", path, *[word for key in changes for word in ("--set", f"{key}={changes[key]}")]]
    reported = subprocess.run(command, capture_output=True, text=True)
    case = Case.read(path)
    if reported.returncode == 0:
        notes = [note.replace("Case:", "--set") for note in case.with_(changes).notes]
        remarks = [line.split(": ", 1) for line in reported.stderr.splitlines()]
        assert notes == [text for word, text in remarks if word in ("note", "warning")]
    else:
        with pytest.raises(CaseError) as caught:
            case.with_(changes)
        problems = [line.removeprefix("error: ") for line in reported.stderr.splitlines() if line.startswith("error: ")]
        assert str(caught.value).replace("Case:", "--set").splitlines() == problems


@pytest.mark.parametrize(
    ("values", "error"),
    [
        (3, TypeError),
        ({3: 4}, TypeError),
        ({"air.velocity": object()}, TypeError),
        ({"air.velocity": b"20 m/s"}, CaseError),
        ({"air.velocity": True}, CaseError),
        ({"air.velocity": 10**400}, CaseError),
        ({"air.velocity": 10**10000}, CaseError),
        ({"air.velocity": "\ud800"}, ValueError),
        ({"run.replicates": 2.5}, CaseError),
        ({"run.replicates": -1}, CaseError),
        ({"run.replicates": 2**70}, CaseError),
        ({"fibre": 3}, CaseError),
        ({"nonsense": {"a": 1}}, CaseError),
        ({}, CaseError),
    ],
)
def test_rejects_what_is_no_case(values: object, error: type[Exception]) -> None:
    with pytest.raises(error):
        Case.from_dict(values)  # type: ignore[arg-type]


def test_rejects_files_that_are_none(tmp_path: Path) -> None:
    (tmp_path / "binary.toml").write_bytes(bytes(range(256)))
    for path in (tmp_path / "nowhere.toml", tmp_path, tmp_path / "binary.toml"):
        with pytest.raises(spunlaid.FileError, match=str(path)):
            Case.read(path)
    with pytest.raises(KeyError, match="air.velocity"):
        Case.starter()["air.velocty"]


def test_the_keys_say_what_they_mean() -> None:
    keys = spunlaid.keys()
    assert keys["air.velocity"].unit == "m/s" and keys["air.velocity"].in_flight and keys["air.velocity"].varies
    assert keys["fibre.root"].words and keys["run.replicates"].unit is None
    assert all(key.meaning and key.allowed for key in keys.values())
    assert "titre" in keys["fibre.linear_density"].synonyms


def test_a_value_may_be_a_change_of_that_of_the_case() -> None:
    case = Case.starter()
    before = case["air.velocity"]
    faster = case.with_({"air.velocity": "+20 %"})
    assert faster["air.velocity"] == pytest.approx(1.2 * before, rel=1e-12)
    assert faster.with_({"air.velocity": "+50 %"})["air.velocity"] == pytest.approx(1.8 * before, rel=1e-12)
    set_before = case.with_({"air.velocity": 20.0}).with_({"air.velocity": "-10 %"})
    assert set_before["air.velocity"] == pytest.approx(18.0, rel=1e-12)
    assert pickle.loads(pickle.dumps(set_before)) == set_before
    assert set_before.with_({"air.velocity": 5.0})["air.velocity"] == 5.0
    with pytest.raises(spunlaid.CaseError, match=r"air\.cabin_pressure = .* is a change of a value that is not given"):
        case.with_({"air.cabin_pressure": "+20 %"})
    flight = spunlaid.Flight(faster, 1)
    flight.set("air.velocity", "+1 m/s")
    same = spunlaid.Flight(faster, 1)
    same.set("air.velocity", 1.2 * before + 1.0)
    for fibres in (flight, same):
        fibres.step("1 ms")
    np.testing.assert_array_equal(flight.positions, same.positions)


def test_a_drag_law_may_be_a_table(tmp_path: Path) -> None:
    case = Case.starter().with_({"run.duration": "20 ms", "run.replicates": 2, "run.spin_up": 0, "drag.across": "ju-shambaugh"})
    # C = 6.96 Re^-0.44 (d/78 µm)^0.404, and the rows reach as far as the flight.
    re = np.geomspace(1e-3, 1e3, 40)
    table = np.column_stack([re, 6.96 * re**-0.44 * (case["fibre.diameter"] / 78e-6) ** 0.404])
    file = tmp_path / "law.csv"
    file.write_text("reynolds,coefficient\n" + "".join(f"{float(x)!r},{float(c)!r}\n" for x, c in table))
    named, of_file = spunlaid.run(case), spunlaid.run(case.with_({"drag.across": file}))
    # A law is not the same bits as its table.
    y, of_table = (run.end_node["y_m"] for run in (named, of_file))
    assert 0 < np.abs(of_table - y).max() < 1e-3 * np.abs(y).max()
    pandas = pytest.importorskip("pandas")
    columns = {"reynolds": table[:, 0], "coefficient": table[:, 1]}
    for law in (table, table.tolist(), columns, pandas.DataFrame(columns)):
        with_table = case.with_({"drag": {"across": law}})
        np.testing.assert_array_equal(spunlaid.run(with_table).end_node["y_m"], of_table)
    # A pickle holds the rows, for a process that does not have this one's files.
    pickled = pickle.dumps(with_table)
    Path(with_table["drag.across"]).unlink()
    np.testing.assert_array_equal(spunlaid.run(pickle.loads(pickled)).end_node["y_m"], of_table)
    study = spunlaid.sweep({"case": case, "vary": {"drag.across": ["ju-shambaugh", file, columns]}})
    first, second, third = study.mean["amplitude_y_m"]
    assert second == third != first == pytest.approx(second, rel=1e-3)
    for wrong in ([1.0, 2.0], {"reynolds": [1, 2]}, np.ones((2, 3)), 0.5):
        with pytest.raises(ValueError, match=r"drag\.across takes the name of a law, the path of a file, or a table"):
            case.with_({"drag.across": wrong})
    with pytest.raises(spunlaid.Error, match=r"csv:3: column coefficient: -1\.0 is not positive"):
        case.with_({"drag.across": [(1.0, 2.0), (3.0, -1.0)]})
