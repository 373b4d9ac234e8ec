"""Files of other programs: fields, records and webs of known values, written by the libraries that write them in practice,
whole and damaged. The program must read the right value, refuse the file, or warn; never silently another number.

    release/prove --files --minutes 10 --seed 3

Needs what requirements.txt names.
"""

import argparse
import collections
import io
import json
import pathlib
import subprocess
import sys
import tempfile
import time
import zlib

import meshio
import numpy as np
import pandas as pd
import PIL.Image
import PIL.PngImagePlugin
import pyvista as pv
import tifffile

# Largest error of a value that is read, relative to the largest one of its kind.
EXACT = 1e-4
# Of a field whose cells hold means, or whose numbers have few digits.
COARSE = 0.05
# Of the CV of a web, whose pixels have a blur and a noise that the program takes out. Of a small sheet with large clouds the program
# adds what the mean of the sheet has taken from the variance, which is less than this fraction of the standard error.
OF_CV = 0.03
OF_ERROR = 0.5
CASE = """version = 1
[fibre]
length = "20 mm"
diameter = "40 µm"
density = "950 kg/m³"
youngs_modulus = "2 GPa"
element_length = "5 mm"
[air]
field = "{file}"
{more}
[drag]
across = "marheineke-wegener"
[run]
duration = "10 ms"
scheme = "implicit-tension"
"""


class Said:
    """What the program says of a file."""

    def __init__(self, done):
        self.code, self.out, self.words = done.returncode, done.stdout, done.stderr

    @property
    def refuses(self):
        return self.code == 1

    @property
    def warns(self):
        return "warning:" in self.words


class Case:
    """A file in a folder of its own, and what is known of it."""

    def __init__(self, program, folder, random):
        self.program, self.folder, self.random = program, pathlib.Path(folder), random
        # What was chosen, in words, for a finding.
        self.choices = []
        self.tolerance = EXACT
        # Whether the file is damaged, so that it may be refused or warned of.
        self.damaged = False

    def choose(self, what, options):
        options = list(options)
        chosen = options[self.random.integers(len(options))]
        self.choices.append(f"{what}: {chosen if isinstance(chosen, (str, int, float, tuple)) else options.index(chosen)}")
        return chosen

    def run(self, *words):
        done = subprocess.run([self.program, *map(str, words)], cwd=self.folder, capture_output=True, text=True)
        return Said(done)


# Fields


def velocity(case):
    """A linear field of velocity, k and epsilon: exact between the points of every mesh."""
    r = case.random
    gradient = r.uniform(-20, 20, (3, 3))
    mean = np.array([r.uniform(15, 40), r.uniform(-3, 3), r.uniform(-3, 3)])
    if case.plane:
        gradient[2, :], gradient[:, 2], mean[2] = 0, 0, 0
    # Both are positive everywhere: no place is farther than 0.2 m along any axis.
    k, slope_of_k = r.uniform(7, 10), r.uniform(-10, 10, 3)
    epsilon, slope = r.uniform(1500, 3000), r.uniform(-2000, 2000, 3)
    if case.plane:
        slope_of_k[2] = slope[2] = 0
    return lambda p: (mean + p @ gradient.T, k + p @ slope_of_k, epsilon + p @ slope)


def axes(case):
    """Coordinates along the axes of a box of some centimetres, evenly spaced or stretched."""
    counts = [int(case.random.integers(5, 12)) for _ in range(3)]
    ends = [case.random.uniform(0.05, 0.2) for _ in range(3)]
    power = case.choose("stretched", [1.0, 1.0, 1.7])
    return [end * np.linspace(0, 1, count) ** power for end, count in zip(ends, counts)]


def mesh_of(case):
    """A PyVista data set, in space or in a plane."""
    x, y, z = axes(case)
    kind = case.choose("mesh", ["image", "rectilinear", "structured", "hexahedra", "tetrahedra", "wedges", "plane", "triangles"])
    case.plane = kind in ("plane", "triangles")
    if kind == "image":
        spacing = [axis[-1] / (len(axis) - 1) for axis in (x, y, z)]
        return pv.ImageData(dimensions=[len(x), len(y), len(z)], spacing=spacing)
    if kind in ("plane", "triangles"):
        z = np.array([0.0])
    grid = pv.RectilinearGrid(x, y, z)
    if kind == "rectilinear":
        return grid
    if kind == "structured":
        grid = grid.cast_to_structured_grid()
        # A sheared box, of which cells stay straight.
        points = grid.points.copy()
        points[:, 1] += case.random.uniform(-0.3, 0.3) * points[:, 0]
        grid.points = points
        return grid
    if kind == "plane":
        return grid.cast_to_structured_grid().cast_to_unstructured_grid()
    if kind == "triangles":
        return grid.cast_to_structured_grid().cast_to_unstructured_grid().triangulate()
    if kind == "tetrahedra":
        return grid.cast_to_structured_grid().cast_to_unstructured_grid().triangulate()
    if kind == "wedges":
        cells, count = [], (len(x), len(y), len(z))
        at = lambda i, j, l: i + count[0] * (j + count[1] * l)
        for i in range(count[0] - 1):
            for j in range(count[1] - 1):
                for l in range(count[2] - 1):
                    for a, b, c in (((0, 0), (1, 0), (0, 1)), ((1, 0), (1, 1), (0, 1))):
                        lower = [at(i + p, j + q, l) for p, q in (a, b, c)]
                        upper = [at(i + p, j + q, l + 1) for p, q in (a, b, c)]
                        cells += [6, *lower, *upper]
        kinds = np.full(len(cells) // 7, pv.CellType.WEDGE)
        return pv.UnstructuredGrid(np.array(cells), kinds, grid.cast_to_structured_grid().points)
    return grid.cast_to_structured_grid().cast_to_unstructured_grid()


NAMES = {
    "U": ["U", "UMean", "velocity", "Velocity", "u"],
    "k": ["k", "kMean", "tke", "turbulent-kinetic-energy", "turb-kinetic-energy"],
    "epsilon": ["epsilon", "epsilonMean", "turb-diss-rate", "eps"],
}


def places_in(case, low, high):
    """Points within the inner part of a box."""
    inside = case.random.uniform(0.3, 0.7, (12, 3))
    return low + inside * (high - low)


def read_field(case, file, at, more=""):
    """What the program says of the field at some places, in axes of the file: velocities, k and length scales."""
    (case.folder / "case.toml").write_text(CASE.format(file=file, more=more), encoding="utf-8")
    pd.DataFrame(at, columns=["x_m", "y_m", "z_m"]).to_csv(case.folder / "at.csv", index=False, float_format="%.12g")
    said = case.run("air", "case.toml", "--at", "at.csv", "--axes", "field", "--quiet")
    if said.code == 0:
        found = pd.read_csv(io.StringIO(said.out))
        said.values = found[["u_m_s", "v_m_s", "w_m_s"]].to_numpy(float)
        said.k = found["k_m2_s2"].to_numpy(float)
    return said


def compare_field(case, said, wanted, k):
    if said.code != 0:
        return f"is refused: {said.words.strip()}"
    scale = np.abs(wanted).max()
    off = np.abs(said.values - wanted).max() / scale
    off_k = np.abs(said.k / k - 1).max()
    if not (off <= case.tolerance and off_k <= max(case.tolerance, 2 * case.tolerance)):
        i = int(np.nanargmax(np.abs(said.values - wanted).max(axis=1)))
        return f"velocity {said.values[i]} for {wanted[i]}, k {said.k[i]:.5g} for {k[i]:.5g}"
    return None


def field_of_mesh(case):
    mesh = mesh_of(case)
    field = velocity(case)
    on_cells = case.choose("values", ["points", "points", "cells"]) == "cells"
    points = mesh.cell_centers().points if on_cells else mesh.points
    u, k, epsilon = field(np.asarray(points, float))
    data = mesh.cell_data if on_cells else mesh.point_data
    number = case.choose("numbers", [np.float64, np.float32])
    for key, values in (("U", u), ("k", k), ("epsilon", epsilon)):
        data[case.choose(key, NAMES[key])] = values.astype(number)
    if on_cells:
        case.tolerance = COARSE
    writer = case.choose("written by", ["pyvista", "pyvista", "legacy", "meshio"])
    binary = case.choose("binary", [True, False])
    low, high = np.reshape(mesh.bounds, (3, 2)).T
    at = places_in(case, low, high)
    if isinstance(mesh, pv.StructuredGrid):
        # A sheared box does not fill its bounds.
        centres = np.asarray(mesh.cell_centers().points)
        middle = np.abs(centres - centres.mean(axis=0)) < 0.3 * (high - low)
        at = centres[middle.all(axis=1)][:12]
    if case.plane:
        at[:, 2] = 0.0
    if writer == "meshio" and not isinstance(mesh, pv.UnstructuredGrid):
        # Hexahedra, because meshio knows no voxels.
        structured = mesh if isinstance(mesh, pv.StructuredGrid) else mesh.cast_to_structured_grid()
        mesh = structured.cast_to_unstructured_grid()
    if writer == "meshio":
        file = "field.vtu"
        vtk = case.folder / "own.vtk"
        mesh.save(vtk)
        meshio.write(case.folder / file, meshio.read(vtk), file_format="vtu", binary=binary)
    else:
        file = "field." + ("vtk" if writer == "legacy" else
                           {pv.ImageData: "vti", pv.RectilinearGrid: "vtr", pv.StructuredGrid: "vts"}.get(type(mesh), "vtu"))
        mesh.save(case.folder / file, binary=binary)
    wanted, k, _ = field(at)
    damage = case.choose("damage", [None, None, "truncated", "unit", "sentinel"])
    path = case.folder / file
    if damage == "truncated":
        case.damaged = True
        content = path.read_bytes()
        path.write_bytes(content[: int(len(content) * case.random.uniform(0.05, 0.97))])
    if damage == "sentinel":
        case.damaged = True
        mark = case.choose("mark", [np.nan, 1e30, -9999.0])
        name = next(name for name in data if np.ndim(data[name]) == 2)
        values = np.array(data[name])
        values[case.random.random(len(values)) < 0.05] = mark
        data[name] = values
        mesh.save(case.folder / file, binary=binary)
    more = ""
    if damage == "unit" and isinstance(mesh, (pv.UnstructuredGrid, pv.StructuredGrid)) and writer != "meshio":
        mesh.points = mesh.points * 1e3
        mesh.save(case.folder / file, binary=binary)
        more = 'field_unit = "1 mm"'
    return compare_field(case, read_field(case, file, at, more), wanted, k)


def table_text(case, frame, style):
    """A table as a program writes it."""
    columns = frame.columns
    if style == "fluent":
        frame = frame.copy()
        frame.insert(0, "nodenumber", np.arange(1, len(frame) + 1))
        head = ",".join(f"{name:>20}" for name in frame.columns)
        rows = "\n".join(",".join(f"{value:20.9E}" if i else f"{int(value):10d}" for i, value in enumerate(row))
                         for row in frame.to_numpy())
        return head + "\n" + rows + "\n"
    if style == "cfx":
        units = {"x": "m", "y": "m", "z": "m", "u": "m s^-1", "v": "m s^-1", "w": "m s^-1", "k": "m^2 s^-2", "e": "m^2 s^-3"}
        names = {"x": "X", "y": "Y", "z": "Z", "u": "Velocity u", "v": "Velocity v", "w": "Velocity w",
                 "k": "Turbulence Kinetic Energy", "e": "Turbulence Eddy Dissipation"}
        head = "\n[Name]\nPlane 1\n\n[Data]\n" + ", ".join(f"{names[c]} [ {units[c]} ]" for c in columns) + "\n"
        return head + "\n".join(", ".join(f"{value:.8e}" for value in row) for row in frame.to_numpy()) + "\n"
    if style == "comsol":
        head = "% Model:              jet.mph\n% Version:            COMSOL 6.2\n% Dimension:          3\n"
        head += f"% Nodes:              {len(frame)}\n% Expressions:        {len(columns) - 3}\n% Length unit:        m\n"
        names = {"k": "k (m^2/s^2)", "e": "ep (m^2/s^3)", "u": "u (m/s)", "v": "v (m/s)", "w": "w (m/s)"}
        head += "% " + "  ".join(names.get(c, c) for c in columns) + "\n"
        return head + "\n".join("  ".join(f"{value:.10g}" for value in row) for row in frame.to_numpy()) + "\n"
    if style == "paraview":
        names = {"x": "Points:0", "y": "Points:1", "z": "Points:2", "u": "U:0", "v": "U:1", "w": "U:2", "k": "k", "e": "epsilon"}
        return frame.rename(columns=names).to_csv(index=False)
    names = {"x": "x [m]", "y": "y [m]", "z": "z [m]", "u": "u [m/s]", "v": "v [m/s]", "w": "w [m/s]", "k": "k [m2/s2]",
             "e": "epsilon [m2/s3]"}
    if style == "german":
        return frame.rename(columns=names).to_csv(index=False, sep=";", decimal=",")
    if style == "km_h":
        frame = frame.copy()
        frame[["u", "v", "w"]] *= 100.0
        names |= {c: f"{c} [cm/s]" for c in "uvw"}
    return frame.rename(columns=names).to_csv(index=False, sep=case.choose("separator", [",", "\t", ";"]))


FLUENT = {"x": "x-coordinate", "y": "y-coordinate", "z": "z-coordinate", "u": "x-velocity", "v": "y-velocity", "w": "z-velocity",
          "k": "turb-kinetic-energy", "e": "turb-diss-rate"}


def field_of_table(case):
    case.plane = case.choose("plane", [False, False, True])
    x, y, z = axes(case)
    if case.plane:
        z = np.array([0.0])
    points = np.stack(np.meshgrid(x, y, z, indexing="ij"), axis=-1).reshape(-1, 3)
    layout = case.choose("points", ["lattice", "shuffled", "scattered"])
    low, high = points.min(axis=0), points.max(axis=0)
    if layout == "scattered":
        count = 3 * len(points)
        points = low + case.random.random((count, 3)) * (high - low)
        if case.plane:
            points[:, 2] = 0.0
    field = velocity(case)
    u, k, epsilon = field(points)
    frame = pd.DataFrame(np.c_[points, u, k, epsilon], columns=list("xyzuvwke"))
    if layout == "shuffled":
        frame = frame.sample(frac=1, random_state=int(case.random.integers(1 << 31)))
    style = case.choose("style", ["fluent", "cfx", "comsol", "paraview", "plain", "german", "km_h"])
    damage = case.choose("damage", [None, None, "truncated", "doubled rows", "sentinel", "digits", "columns", "doubled column", "CRLF"])
    if damage == "doubled rows":
        frame = pd.concat([frame, frame.sample(frac=0.2, random_state=1)])
        case.damaged = True
    if damage == "sentinel":
        mark = case.choose("mark", [np.nan, 1e30, -9999.0, -999.0])
        for name in "uvw":
            frame.loc[frame.index[case.random.random(len(frame)) < 0.05], name] = mark
        case.damaged = True
    if damage == "digits":
        frame[list("uvw")] = frame[list("uvw")].round(0)
        case.tolerance, case.damaged = COARSE, True
    if damage == "columns":
        frame = frame[list(case.random.permutation(list("xyzuvwke")))]
    text = table_text(case, frame.rename(columns=FLUENT) if style == "fluent" else frame, style)
    if damage == "doubled column":
        rows = [line + ("," if "," in line else "\t" if "\t" in line else " ") + line.replace(";", ",").split(",")[0]
                for line in text.splitlines()]
        text, case.damaged = "\n".join(rows) + "\n", True
    if damage == "truncated":
        text, case.damaged = text[: int(len(text) * case.random.uniform(0.3, 0.99))], True
    if damage == "CRLF":
        text = "\ufeff" + text.replace("\n", "\r\n")
    file = "field.txt" if style == "comsol" else "field.csv"
    (case.folder / file).write_text(text, encoding="utf-8", newline="")
    at = places_in(case, low, high)
    if case.plane:
        at[:, 2] = 0.0
    wanted, k, _ = field(at)
    if layout == "scattered":
        # Between points at random the program fits a plane, whose weights are its own.
        case.tolerance = max(case.tolerance, 1e-3)
    return compare_field(case, read_field(case, file, at), wanted, k)


# Records


def record(case):
    r = case.random
    count, rate = int(r.integers(4000, 20000)), float(case.choose("rate", [1e3, 10e3, 25e3]))
    noise, memory = r.normal(size=count), r.uniform(0.9, 0.98)
    u = np.zeros(count)
    for i in range(1, count):
        u[i] = memory * u[i - 1] + noise[i]
    mean = r.uniform(5, 60)
    u = mean + u / u.std() * mean * r.uniform(0.05, 0.2)
    wanted = {"mean": u.mean(), "intensity": u.std() / u.mean(), "rate": rate}
    unit, factor = case.choose("unit", [("m/s", 1.0), ("cm/s", 100.0), ("mm/s", 1000.0)])
    clock, per_second = case.choose("time", [("s", 1.0), ("ms", 1e3), ("us", 1e6)])
    header = case.choose("header", ["{} [{}]", "{} ({})", "{}_{}"])
    tidy = lambda unit: unit.replace("/", "_") if header == "{}_{}" else unit
    frame = pd.DataFrame({header.format("time", tidy(clock)): np.arange(count) / rate * per_second,
                          header.format("u", tidy(unit)): u * factor})
    damage = case.choose("damage", [None, None, "gaps", "sentinel", "truncated", "digits", "repeated", "wrong unit of time"])
    name = frame.columns[1]
    if damage == "gaps":
        frame.loc[r.integers(10, count - 10, 20), name] = np.nan
        case.damaged, case.tolerance = True, 2e-3
    if damage == "sentinel":
        frame.loc[r.integers(10, count - 10, 20), name] = case.choose("mark", [-9999.0, 1e30, 0.0])
        case.damaged, case.tolerance = True, 2e-3
    if damage == "digits":
        frame[name] = frame[name].round(int(np.ceil(-np.log10(u.std() * factor))) if case.choose("how many", [0, 1]) else 0)
        case.damaged, case.tolerance = True, COARSE
    if damage == "repeated":
        start = int(r.integers(100, count - 600))
        frame = pd.concat([frame.iloc[: start + 200], frame.iloc[start:]])
        case.damaged, case.tolerance = True, 2e-2
    if damage == "wrong unit of time":
        frame = frame.rename(columns={frame.columns[0]: header.format("time", {"s": "ms", "ms": "s", "us": "ms"}[clock])})
        # Nothing in the file shows this, except that turbulence is slower or faster than is usual.
        return None
    writer = case.choose("written by", ["pandas", "pandas, semicolons", "pandas, decimal commas", "with an index", "parquet", "tabs"])
    file = "record.parquet" if writer == "parquet" else "record.csv"
    path = case.folder / file
    if writer == "parquet":
        frame.to_parquet(path, index=False, compression=case.choose("compression", ["snappy", None]))
    else:
        digits = {"float_format": "%.9g"}
        separator = {"pandas, semicolons": ";", "pandas, decimal commas": ";", "tabs": "\t"}.get(writer, ",")
        decimal = "," if writer == "pandas, decimal commas" else "."
        frame.to_csv(path, index=writer == "with an index", sep=separator, decimal=decimal,
                     encoding=case.choose("encoding", ["utf-8", "utf-8-sig"]),
                     lineterminator=case.choose("lines end", ["\n", "\r\n"]), **digits)
    if damage == "truncated":
        content = path.read_bytes()
        path.write_bytes(content[: int(len(content) * r.uniform(0.5, 0.99))])
        # What is left is a record too, of nearly the same numbers.
        case.damaged, case.tolerance = True, 0.2
    said = case.run("analyse", file, "--json", "--quiet")
    if said.code != 0:
        return f"is refused: {said.words.strip()}"
    found = json.loads(said.out)
    values = {"mean": found["mean_velocity_m_s"]["value"], "intensity": found["turbulence_intensity"]["value"],
              "rate": found["record"]["rate_hz"]}
    for key, value in wanted.items():
        tolerance = max(case.tolerance, 1e-3) if key != "intensity" else max(3 * case.tolerance, 2e-3)
        if not abs(values[key] / value - 1) <= tolerance:
            return f"{key} is {values[key]:.6g} for {value:.6g}"
    return None


# Webs


def cv(web, side):
    """CV of the mean weight of square patches at all places."""
    sums = np.pad(web, ((1, 0), (1, 0))).cumsum(axis=0).cumsum(axis=1)
    boxes = sums[side:, side:] - sums[:-side, side:] - sums[side:, :-side] + sums[:-side, :-side]
    return boxes.std() / boxes.mean()


def web(case):
    r = case.random
    rows, columns = int(r.integers(200, 400)), int(r.integers(200, 400))
    waves = np.hypot(*np.meshgrid(np.fft.fftfreq(columns), np.fft.fftfreq(rows)))
    clouds = np.real(np.fft.ifft2(np.fft.fft2(r.normal(size=(rows, columns))) * np.exp(-((waves * r.uniform(12, 25)) ** 2))))
    sheet = np.clip(1 + r.uniform(0.06, 0.15) * clouds / clouds.std(), 0.3, None)
    pixel = float(case.choose("pixel", [0.1, 0.2, 0.05]))
    kind = case.choose("kind", ["npy", "csv", "tiff of weights", "png", "tiff", "tiff"])
    words = ["--keep-shading", "--keep-spots"]
    tagged = False
    if kind == "npy":
        np.save(case.folder / "web.npy", np.asarray(sheet, order=case.choose("order", ["C", "F"]), dtype=case.choose("numbers", [np.float64, np.float32])))
        file = "web.npy"
    elif kind == "csv":
        file = "web.csv"
        np.savetxt(case.folder / file, sheet, delimiter=case.choose("separator", [",", ";", "\t"]), fmt="%.6g")
    elif kind == "tiff of weights":
        file = "web.tif"
        tifffile.imwrite(case.folder / file, sheet.astype(np.float32), compression=case.choose("compression", [None, "zlib", "lzw"]))
        words += ["--light", "weight"]
    else:
        bits = case.choose("bits", [8, 16])
        white = 2**bits - 1
        grey = np.round(white * np.exp(-r.uniform(0.3, 1.2) * sheet)).astype(np.uint8 if bits == 8 else np.uint16)
        # What the levels say, with their own rounding.
        sheet = -np.log(grey / white)
        colours = case.choose("colours", ["grey", "grey", "rgb", "rgba"])
        if colours != "grey":
            full = np.full_like(grey, white)
            grey = np.dstack([grey] * 3 + ([full] if colours == "rgba" else []))
        tagged = case.choose("resolution in the file", [True, False])
        if kind == "png":
            file = "web.png"
            if bits == 16 and colours != "grey":
                return None
            image = PIL.Image.fromarray(grey)
            image.save(case.folder / file, **({"dpi": (25.4 / pixel, 25.4 / pixel)} if tagged else {}))
        else:
            file = "web.tif"
            more = {"resolution": (10 / pixel, 10 / pixel), "resolutionunit": "CENTIMETER"} if tagged else {}
            if case.choose("inches", [True, False]) and tagged:
                more = {"resolution": (25.4 / pixel, 25.4 / pixel), "resolutionunit": "INCH"}
            layout = case.choose("layout", [{}, {"tile": (64, 64)}, {"rowsperstrip": 7}])
            photometric = "rgb" if colours != "grey" else "minisblack"
            extra = {"extrasamples": ["unassalpha"]} if colours == "rgba" else {}
            compression = case.choose("compression", [None, "zlib", "lzw", "packbits"])
            # The decoder fails in tiles that reach beyond the picture, and the message says so.
            case.damaged = compression == "lzw" and "tile" in layout
            tifffile.imwrite(case.folder / file, grey, photometric=photometric, bigtiff=case.choose("bigtiff", [False, True]),
                             byteorder=case.choose("bytes", ["<", ">"]), compression=compression, predictor=False,
                             **layout, **more, **extra)
    damage = case.choose("damage", [None, None, None, "truncated"])
    path = case.folder / file
    if damage == "truncated":
        content = path.read_bytes()
        path.write_bytes(content[: int(len(content) * r.uniform(0.3, 0.97))])
        case.damaged = True
    if not tagged:
        words += ["--pixel", f"{pixel} mm"]
    sides = [10, 20]
    words += ["--patches", ",".join(f"{side * pixel:g} mm" for side in sides)]
    said = case.run("analyse", file, "--json", "--quiet", *words)
    if said.code != 0:
        return f"is refused: {said.words.strip()}"
    patches = json.loads(said.out)["web"]["patches"]
    for side, patch in zip(sides, patches):
        wanted, found = cv(sheet, side), patch["cv"]
        more = max(OF_CV * wanted, OF_ERROR * (patch["cv_standard_error"] or 0.0))
        is_right = wanted - OF_CV * wanted <= found <= wanted + more
        if abs(patch["patch_m"] / (side * pixel * 1e-3) - 1) > 1e-3 or not is_right:
            return f"CV {found:.5f} over {patch['patch_m']:.5g} m for {wanted:.5f} over {side * pixel * 1e-3:.5g} m"
    return None


KINDS = {"field of a mesh": field_of_mesh, "field of a table": field_of_table, "record": record, "web": web}


def outcome(kind, program, folder, seed, number):
    """A case and what is wrong with what the program says of it; None if nothing."""
    case = Case(program, folder, np.random.default_rng([zlib.crc32(kind.encode()), seed, number]))
    spoken = []
    run = case.run

    def remembered(*words):
        spoken.append(run(*words))
        return spoken[-1]

    case.run = remembered
    wrong = KINDS[kind](case)
    said = spoken[-1] if spoken else None
    if said is None:
        return case, "not tried", None
    if said.code not in (0, 1):
        return case, "wrong", f"exit code {said.code}: {said.words}"
    if wrong is None:
        return case, "right", None
    if case.damaged and said.refuses:
        return case, "refused", None
    if case.damaged and said.warns:
        return case, "warned", None
    return case, "wrong", wrong


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--program", required=True)
    parser.add_argument("--minutes", type=float, default=1.0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--draw", type=int)
    parser.add_argument("--only", choices=KINDS)
    parser.add_argument("--keep", help="a folder for the files of one draw")
    asked = parser.parse_args()
    program = str(pathlib.Path(asked.program).resolve())
    counts = collections.Counter()
    begun, number, found = time.monotonic(), asked.draw or 0, False
    kinds = [asked.only] if asked.only else list(KINDS)
    while time.monotonic() - begun < 60 * asked.minutes:
        for kind in kinds:
            with tempfile.TemporaryDirectory() as folder:
                if asked.keep:
                    folder = asked.keep
                    pathlib.Path(folder).mkdir(exist_ok=True)
                case, what, wrong = outcome(kind, program, folder, asked.seed, number)
            counts[kind, what] += 1
            if what == "wrong":
                found = True
                again = f"--seed {asked.seed} --draw {number} --only '{kind}'"
                print(f"\nFINDING: {again}\n{wrong}\n" + "\n".join(case.choices), flush=True)
        number += 1
        if asked.draw is not None:
            break
    for (kind, what), count in sorted(counts.items()):
        print(f"{kind:18} {what:10} {count:7}")
    sys.exit(int(found))


if __name__ == "__main__":
    main()
