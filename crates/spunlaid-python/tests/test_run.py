"""Runs: arrays, measures, folders, pickles."""

from __future__ import annotations

import os
import pickle
import shutil
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import spunlaid
from spunlaid import Case


def same(a: spunlaid.Run, b: spunlaid.Run) -> None:
    """Both have the same bits, apart from what they cost."""
    for name in ("end_node", "energy"):
        of_a, of_b = getattr(a, name), getattr(b, name)
        assert of_a.keys() == of_b.keys()
        for column in of_a:
            np.testing.assert_array_equal(of_a[column], of_b[column], err_msg=column)
    assert a.measures.keys() == b.measures.keys()
    for column, measure in a.measures.items():
        np.testing.assert_array_equal(measure.values, b.measures[column].values, err_msg=column)
        np.testing.assert_array_equal([measure.mean, measure.shown], [b.measures[column].mean, b.measures[column].shown])
    np.testing.assert_array_equal(a.shapes.positions_m, b.shapes.positions_m)
    assert len(a.laid) == len(b.laid)
    for laid_a, laid_b in zip(a.laid, b.laid, strict=True):
        for column in laid_a:
            np.testing.assert_array_equal(laid_a[column], laid_b[column])
    summaries = [{**run.summary, "performance": None} for run in (a, b)]
    assert summaries[0] == summaries[1]


def test_shapes_of_the_arrays(short: Case) -> None:
    run = spunlaid.run(short, 11, threads=2)
    times, replicates = short.instants, 11
    assert run.end_node["y_m"].shape == (replicates, times) == run.energy["kinetic_j"].shape
    np.testing.assert_allclose(run.end_node["time_s"], np.arange(times) * 1e-3, rtol=0, atol=1e-15)
    kept, instants, nodes, three = run.shapes.positions_m.shape
    assert (kept, instants, three) == (8, len(run.shapes.time_s), 3)
    # The end of a shape is the free end of the same fibre at the same time.
    at = np.searchsorted(run.end_node["time_s"], run.shapes.time_s - 1e-9)
    for axis, column in enumerate(("x_m", "y_m", "z_m")):
        np.testing.assert_array_equal(run.shapes.positions_m[:, :, -1, axis], run.end_node[column][:8, at])
    assert nodes == round(short["fibre.length"] / short["fibre.element_length"]) + 1
    with pytest.raises(ValueError, match="read-only"):
        run.end_node["y_m"][0, 0] = 1.0
    assert run.laid == []


def test_a_run_says_when_what_it_recorded_has_been_removed(short: Case, tmp_path: Path) -> None:
    run = spunlaid.run(short, 2)
    shutil.rmtree(run._tables.path)
    with pytest.raises(spunlaid.FolderError, match="has been removed"):
        run.save(tmp_path / "a")
    assert run.measures["amplitude_y_m"].mean > 0 and not (tmp_path / "a").exists()


def test_a_path_or_a_dict_is_a_case(short: Case, tmp_path: Path) -> None:
    (tmp_path / "case.toml").write_text(Case.starter().to_toml())
    changes = {key: value for key, value in short.items() if Case.starter()[key] != value}
    runs = [
        spunlaid.run(short),
        spunlaid.run(short.to_dict()),
        spunlaid.run(dict(short)),
        spunlaid.run(tmp_path / "case.toml", set=changes),
        spunlaid.run(str(tmp_path / "case.toml"), short["run.replicates"], set=changes | {"run.replicates": 99}),
    ]
    for run in runs[1:]:
        np.testing.assert_array_equal(run.end_node["y_m"], runs[0].end_node["y_m"])
    with pytest.raises(spunlaid.FileError, match="nowhere"):
        spunlaid.run("nowhere.toml")
    with pytest.raises(spunlaid.CaseError, match=r"fibre\.diameter is missing") as caught:
        spunlaid.run({"fibre": {"length": 1.0}})
    assert {problem.line for problem in caught.value.problems} == {None}


def test_measures_are_numbers_and_a_frame(short: Case) -> None:
    run = spunlaid.run(short, 8)
    table = run.measures.to_pandas()
    assert list(table.index) == list(run.measures) and (table["n"] == [np.isfinite(m.values).sum() for m in run.measures.values()]).all()
    for column, measure in run.measures.items():
        assert float(measure) == table.loc[column, "mean"] == measure.mean
    assert 2 * float(run.measures["amplitude_y_m"]) > 0
    single = spunlaid.run(short, 1).measures.to_pandas()
    assert single["standard_error"].isna().all() and single["standard_error"].dtype == float


def test_measures_are_those_of_the_arrays(short: Case) -> None:
    run = spunlaid.run(short, 8)
    amplitude = run.measures["amplitude_y_m"]
    assert amplitude.values.shape == (8,) and amplitude.mean == run.summary["end_node"]["amplitude_y_m"]["mean"]
    np.testing.assert_allclose(amplitude.mean, amplitude.values.mean(), rtol=1e-14)
    np.testing.assert_allclose(amplitude.standard_error, amplitude.values.std(ddof=1) / np.sqrt(8), rtol=1e-12)
    # It is taken at every step, the array has every fiftieth, and neighbouring ones hardly differ.
    np.testing.assert_allclose(run.end_node["y_m"].std(axis=1), amplitude.values, rtol=0.1)
    with pytest.raises(KeyError, match="did you mean 'amplitude_y_m'"):
        run.measures["amplitude_y"]
    assert all(len(curve.at) == len(curve.mean) for curve in run.curves.values()) and run.curves


def test_identical_for_any_threads_alone_and_together(short: Case) -> None:
    runs = [spunlaid.run(short, 17, threads=threads) for threads in (1, 3)]
    same(*runs)
    few = spunlaid.run(short, 2)
    np.testing.assert_array_equal(few.end_node["z_m"], runs[0].end_node["z_m"][:2])
    other = spunlaid.run(short, 2, seed=99)
    assert not np.array_equal(other.end_node["z_m"], few.end_node["z_m"])


def test_identical_figures_to_those_of_the_program(short: Case, program: Path, tmp_path: Path) -> None:
    (tmp_path / "case.toml").write_text(short.to_toml(), "utf-8")
    command = [program, "run", tmp_path / "case.toml", "--out", tmp_path / "program", "--quiet", "--figures", "pdf,png"]
    subprocess.run([*command, "--figure-width", "90 mm"], check=True, capture_output=True)
    run = spunlaid.run(tmp_path / "case.toml")
    run.save(tmp_path / "a", figures=["pdf", "png"], figure_width="90 mm")
    run.save(tmp_path / "b", figures="pdf, PNG", figure_width=0.09)
    for name in ("a", "b"):
        of_program, own = ({path.name: path.read_bytes() for path in (tmp_path / of / "figures").iterdir()} for of in ("program", name))
        assert {Path(file).suffix for file in own} == {".csv", ".pdf", ".png"} and own == of_program
    run.save(tmp_path / "usual")
    assert {path.suffix for path in (tmp_path / "usual" / "figures").iterdir()} == {".csv", ".svg", ".png"}


@pytest.mark.parametrize(
    ("options", "error", "says"),
    [
        ({"figures": ["gif"]}, ValueError, "figures: write one of svg, png, pdf"),
        ({"figures": 3}, TypeError, "write the names of formats"),
        ({"figure_width": "90"}, ValueError, "figure_width: write one-column"),
        ({"figure_width": 0.9}, ValueError, "figure_width: write one-column"),
        ({"figure_width": []}, TypeError, "figure_width: write a text"),
    ],
)
def test_rejects_figures_that_cannot_be_written(short: Case, options: dict[str, Any], error: type[Exception], says: str, tmp_path: Path) -> None:
    with pytest.raises(error, match=says):
        spunlaid.run(short, 1).save(tmp_path / "r", **options)
    assert not (tmp_path / "r").exists()


@pytest.mark.parametrize("kind", ["short", "fed"])
def test_identical_through_pickle_and_folder(kind: str, tmp_path: Path, request: pytest.FixtureRequest) -> None:
    run = spunlaid.run(request.getfixturevalue(kind))
    again = pickle.loads(pickle.dumps(run))
    same(run, again)
    again.save(tmp_path / "pickled")
    run.save(tmp_path / "r")
    loaded = spunlaid.load(tmp_path / "r")
    same(run, loaded)
    assert loaded.case == run.case and loaded.step_check == run.step_check and loaded.notes == run.notes
    for name in ("summary.json", "report.html", "energy.parquet", "case.toml"):
        first, second = ((tmp_path / folder / name).read_bytes() for folder in ("r", "pickled"))
        assert first == second, name
    same(run, pickle.loads(pickle.dumps(loaded)))
    with pytest.raises(spunlaid.FolderError, match="holds results already"):
        run.save(tmp_path / "r")
    run.save(tmp_path / "r", force=True)
    loaded.save(tmp_path / "copy")
    same(run, spunlaid.load(tmp_path / "copy"))
    with pytest.raises(ValueError, match="copied with their figures as they are"):
        loaded.save(tmp_path / "print", figures=["pdf"])
    with pytest.raises(spunlaid.FolderError, match="holds results already"):
        loaded.save(tmp_path / "copy")


def test_saving_over_results_loses_nothing(short: Case, fed: Case, tmp_path: Path) -> None:
    laid, fixed = spunlaid.run(fed), spunlaid.run(short)
    laid.save(tmp_path / "r")
    (tmp_path / "r" / "figures" / "mine.txt").write_text("mine")
    loaded = spunlaid.load(tmp_path / "r")
    with pytest.raises(spunlaid.FolderError, match="is where these results are"):
        loaded.save(tmp_path / "r", force=True)
    same(laid, loaded)
    # Results of another kind leave nothing behind, and files of the user's stay, whether they were computed or loaded.
    fixed.save(tmp_path / "fixed")
    for other in (fixed, spunlaid.load(tmp_path / "fixed")):
        laid.save(tmp_path / "s", force=True)
        (tmp_path / "s" / "figures" / "mine.txt").write_text("mine")
        other.save(tmp_path / "s", force=True)
        assert not (tmp_path / "s" / "laid.parquet").exists()
        assert (tmp_path / "s" / "figures" / "mine.txt").read_text() == "mine"
        same(fixed, spunlaid.load(tmp_path / "s"))


@pytest.mark.skipif(not hasattr(os, "fork"), reason="this system does not fork")
def test_a_forked_child_leaves_the_run_of_its_parent() -> None:
    code = (
        "import os, sys, spunlaid\n"
        "run = spunlaid.run(sys.argv[1], set={'run.duration': '0.05 s', 'run.spin_up': '0 s'})\n"
        "child = os.fork()\n"
        "if child == 0: sys.exit()\n"
        "os.waitpid(child, 0)\n"
        "print(len(run.end_node))\n"
    )
    table1 = Path(__file__).parents[3] / "cases" / "table1.toml"
    done = subprocess.run([sys.executable, "-W", "ignore", "-c", code, str(table1)], capture_output=True, text=True, timeout=300)
    assert done.returncode == 0 and int(done.stdout) > 0, done.stderr


def test_lost_fibres_are_reported_and_in_no_mean(tmp_path: Path) -> None:
    # A gust of 90 km/s in a record: the fibres whose stretch has it are lost.
    velocity = ["1e5" if 400 <= i < 420 else f"{10 + i * i % 101 * 0.01}" for i in range(2000)]
    rows = "".join(f"{i * 1e-3},{u}\n" for i, u in enumerate(velocity))
    (tmp_path / "gust.csv").write_text(f"time_s,u_m_s\n{rows}")
    (tmp_path / "gust.toml").write_text(
        "version = 1\n[fibre]\nlength = '0.2 m'\ndiameter = '50 µm'\ndensity = '950 kg/m³'\nyoungs_modulus = '2 GPa'\n"
        "element_length = '50 mm'\n[air]\nrecord = 'gust.csv'\nvelocity = '10 m/s'\nturbulence_intensity = 900\n"
        "length_scale = '0.2 m'\n[run]\nduration = '50 ms'\ntime_step = '20 µs'\nreplicates = 12\n",
        encoding="utf-8",
    )
    run = spunlaid.run(spunlaid.Case.read(tmp_path / "gust.toml"))
    lost = [number - 1 for number, _, _ in run.lost]
    assert 0 < len(lost) < 11 and lost == sorted(lost)
    assert all(reason.startswith(f"replicate {number}: ") for number, _, reason in run.lost)
    assert any("all others are in the results" in note for note in run.notes)
    amplitude = run.measures["amplitude_y_m"]
    assert np.array_equal(np.flatnonzero(np.isnan(amplitude.values)), lost)
    assert np.isclose(amplitude.mean, np.nanmean(amplitude.values), rtol=1e-12)
    assert np.array_equal(np.flatnonzero(np.isnan(run.end_node["y_m"][:, 0])), lost)
    run.save(tmp_path / "r")
    for again in (pickle.loads(pickle.dumps(run)), spunlaid.load(tmp_path / "r")):
        assert again.lost == run.lost
        assert np.array_equal(again.end_node["y_m"], run.end_node["y_m"], equal_nan=True)


def test_rejects_folders_that_are_no_runs(tmp_path: Path) -> None:
    for text in (None, "", "[]", "{}", '{"web": 1}'):
        if text is not None:
            (tmp_path / "summary.json").write_text(text)
        with pytest.raises(spunlaid.FolderError, match=r"summary\.json"):
            spunlaid.load(tmp_path)


def test_what_a_fed_fibre_lays(fed: Case) -> None:
    run = spunlaid.run(fed)
    assert run.end_node == {} and len(run.laid) == 3
    for laid in run.laid:
        spacing = np.diff(laid["s_m"])
        np.testing.assert_allclose(spacing, spacing[0], rtol=1e-9)
        # What has come down was fed before, and the way to the belt is still full of fibre, stretched by less than 1 %.
        # A fibre begins with two elements, and points are reported to one.
        fed_by_then = fed["feed.speed"] * laid["time_s"] + 2 * spacing[0]
        assert np.all(laid["s_m"] + 0.99 * fed["belt.distance"] <= fed_by_then + spacing[0])
        # It does not lag behind by more than the loops that ten times the way would hold.
        assert np.all(fed_by_then - laid["s_m"] < 10 * fed["belt.distance"])


def test_frames(short: Case) -> None:
    run = spunlaid.run(short)
    table, data = run.to_pandas(), run.to_xarray()
    assert len(table) == 3 * short.instants
    np.testing.assert_array_equal(table.loc[2, "y_m"], run.end_node["y_m"][1])
    np.testing.assert_array_equal(data["y_m"].sel(replicate=2), run.end_node["y_m"][1])
    np.testing.assert_array_equal(data["amplitude_y_m"], run.measures["amplitude_y_m"].values)
    # Each variable has its unit, in words that other programs read; the name of its column ends with the same.
    assert all(variable.attrs["units"] for name, variable in data.variables.items() if name != "replicate")
    units = {name: data[name].attrs["units"] for name in data.variables if name != "replicate"}
    known = {"time_s": "s", "y_m": "m", "kinetic_j": "J", "balance_error_percent": "percent", "frequency_y_hz": "Hz"}
    assert known.items() <= units.items() and units["amplitude_y_m"] == run.measures["amplitude_y_m"].unit == "m"
    for name, unit in units.items():
        assert unit == "1" or name.endswith("_" + unit.lower().replace("/", "_")), (name, unit)


def test_a_notebook_shows_the_report(short: Case) -> None:
    run = spunlaid.run(short)
    shown = run._repr_html_()
    assert shown.startswith('<iframe sandbox="allow-scripts ') and "allow-same-origin" not in shown[:200]
    assert " srcdoc=" in shown and "&lt;html" in shown.lower() and "amplitude_y_m" in repr(run)


def test_progress_is_reported_and_its_errors_come_through(short: Case) -> None:
    reported: list[tuple[int, int]] = []
    spunlaid.run(short, 40, progress=lambda done, of: reported.append((done, of)))
    assert reported[-1][0] == reported[-1][1] > 0 and reported == sorted(reported)
    slow = short.with_({"run.duration": 50.0, "run.replicates": 8})

    def refuse(done: int, of: int) -> None:
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        spunlaid.run(slow, progress=refuse)


def test_ctrl_c_stops_a_run(short: Case) -> None:
    slow = short.with_({"run.duration": 100.0, "run.replicates": 8})
    # A shell starts what runs in the background with the signal ignored.
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    timer = threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    began = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        spunlaid.run(slow, threads=1)
    timer.join()
    signal.signal(signal.SIGINT, before)
    assert time.monotonic() - began > 0.25, "it ran until the signal came"
    # The next one flies.
    assert spunlaid.run(short).measures


def test_the_interpreter_is_free_while_fibres_fly(short: Case) -> None:
    slow = short.with_({"run.duration": 0.05, "run.replicates": 8})
    runs: list[spunlaid.Run] = []
    thread = threading.Thread(target=lambda: runs.append(spunlaid.run(slow, threads=1)))
    thread.start()
    counted = 0
    while thread.is_alive():
        counted += 1
        time.sleep(0)
    assert counted > 100 and len(runs) == 1


def test_threads_of_python_get_the_same_bits(short: Case) -> None:
    runs: dict[int, spunlaid.Run] = {}

    def fly(number: int) -> None:
        runs[number] = spunlaid.run(short, threads=1)

    threads = [threading.Thread(target=fly, args=(number,)) for number in range(6)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for run in runs.values():
        np.testing.assert_array_equal(run.end_node["y_m"], runs[0].end_node["y_m"])


def test_rejects_bad_arguments(short: Case) -> None:
    for arguments in ({"threads": 0}, {"threads": 10**9}, {"threads": -1}):
        with pytest.raises(ValueError, match="threads"):
            spunlaid.run(short, **arguments)  # type: ignore[arg-type]
    with pytest.raises(TypeError):
        spunlaid.run(short, threads=1.5)  # type: ignore[arg-type]
    with pytest.raises(TypeError):
        spunlaid.run(3)  # type: ignore[arg-type]
    with pytest.raises(spunlaid.CaseError, match=r"run\.replicates"):
        spunlaid.run(short, 0)
    lost = short.with_({"run.scheme": "semi-implicit-euler", "run.time_step": "1 us"})
    assert lost["run.scheme"] == "semi-implicit-euler"
