"""Makes the files beside this one: the same linear field on a unit cube, by VTK's own writers and by meshio.

    pip install vtk==9.7.2 meshio==5.3.5 && python make.py
"""

import os

import meshio
import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk


def values(points):
    x, y, z = points.T
    return {
        "U": np.column_stack([1 + x, 2 * y - z, x + y + z]),
        "k": 1 + z,
        "epsilon": 2 + y,
    }


def with_values(data, points, kind=np.float64):
    for name, numbers in values(points).items():
        array = numpy_to_vtk(np.ascontiguousarray(numbers.astype(kind)), deep=True)
        array.SetName(name)
        data.GetPointData().AddArray(array)
    return data


# Eight cubes, each cut its own way; the middles of cubes and of edges come after the corners.
corners = np.array([[x, y, z] for z in range(3) for y in range(3) for x in range(3)]) / 2.0
cube = [0, 1, 4, 3, 9, 10, 13, 12]
firsts = [0, 1, 3, 4, 9, 10, 12, 13]
sides = [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]]


def mixed():
    points = [tuple(p) for p in corners]
    grid = vtk.vtkUnstructuredGrid()

    def insert(kind, ids):
        cell = vtk.vtkIdList()
        for i in ids:
            cell.InsertNextId(i)
        grid.InsertNextCell(kind, cell)

    for number, first in enumerate(firsts):
        c = [first + i for i in cube]
        if number in (0, 7):
            insert(vtk.VTK_HEXAHEDRON, c)
        elif number == 1:
            insert(vtk.VTK_VOXEL, [c[i] for i in (0, 1, 3, 2, 4, 5, 7, 6)])
        elif number in (2, 4):
            points.append(tuple(np.mean([points[i] for i in c], axis=0)))
            for side in sides:
                insert(vtk.VTK_PYRAMID, [c[i] for i in side] + [len(points) - 1])
        elif number == 3:
            insert(vtk.VTK_WEDGE, [c[i] for i in (0, 1, 2, 4, 5, 6)])
            insert(vtk.VTK_WEDGE, [c[i] for i in (0, 2, 3, 4, 6, 7)])
        elif number == 5:
            # Points along the edges: bottom, top, upright.
            edges = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)]
            ids = list(c)
            for a, b in edges:
                points.append(tuple(np.mean([points[c[a]], points[c[b]]], axis=0)))
                ids.append(len(points) - 1)
            insert(vtk.VTK_QUADRATIC_HEXAHEDRON, ids)
        else:
            insert(vtk.VTK_POLYHEDRON, [6] + [i for side in sides for i in [4] + [c[j] for j in side]])
    # A face of the boundary.
    insert(vtk.VTK_QUAD, [0, 1, 4, 3])
    vtk_points = vtk.vtkPoints()
    vtk_points.SetDataTypeToDouble()
    for point in points:
        vtk_points.InsertNextPoint(point)
    grid.SetPoints(vtk_points)
    return with_values(grid, np.array(points))


def write_xml(writer, data, name, mode="appended", compressor="none", base64=False, wide=False, big=False):
    writer.SetInputData(data)
    writer.SetFileName(name)
    {"ascii": writer.SetDataModeToAscii, "inline": writer.SetDataModeToBinary, "appended": writer.SetDataModeToAppended}[mode]()
    {
        "none": writer.SetCompressorTypeToNone,
        "zlib": writer.SetCompressorTypeToZLib,
        "lz4": writer.SetCompressorTypeToLZ4,
        "lzma": writer.SetCompressorTypeToLZMA,
    }[compressor]()
    writer.SetEncodeAppendedData(base64)
    writer.SetBlockSize(1024)
    (writer.SetHeaderTypeToUInt64 if wide else writer.SetHeaderTypeToUInt32)()
    (writer.SetByteOrderToBigEndian if big else writer.SetByteOrderToLittleEndian)()
    assert writer.Write() == 1


def write_legacy(writer, data, name, binary, version=51):
    writer.SetInputData(data)
    writer.SetFileName(name)
    (writer.SetFileTypeToBinary if binary else writer.SetFileTypeToASCII)()
    writer.SetFileVersion(version)
    assert writer.Write() == 1


def image():
    data = vtk.vtkImageData()
    data.SetDimensions(4, 3, 2)
    data.SetSpacing(1 / 3, 1 / 2, 1)
    points = np.array([data.GetPoint(i) for i in range(24)])
    return with_values(data, points, np.float32)


def rectilinear():
    data = vtk.vtkRectilinearGrid()
    axes = [[0, 0.2, 0.5, 1], [0, 0.7, 1], [0, 1]]
    data.SetDimensions(4, 3, 2)
    for numbers, put in zip(axes, [data.SetXCoordinates, data.SetYCoordinates, data.SetZCoordinates]):
        put(numpy_to_vtk(np.array(numbers), deep=True))
    return with_values(data, np.array([data.GetPoint(i) for i in range(24)]))


def structured():
    data = vtk.vtkStructuredGrid()
    data.SetDimensions(4, 3, 2)
    points = np.array([[x / 3, y / 2 + 0.1 * x * (3 - x) * y * (2 - y), z] for z in range(2) for y in range(3) for x in range(4)])
    vtk_points = vtk.vtkPoints()
    vtk_points.SetData(numpy_to_vtk(points, deep=True))
    data.SetPoints(vtk_points)
    return with_values(data, points)


grid = mixed()
xml = vtk.vtkXMLUnstructuredGridWriter
write_xml(xml(), grid, "vtk_ascii.vtu", mode="ascii")
write_xml(xml(), grid, "vtk_inline.vtu", mode="inline")
write_xml(xml(), grid, "vtk_inline_zlib_uint64.vtu", mode="inline", compressor="zlib", wide=True)
write_xml(xml(), grid, "vtk_raw_big_endian.vtu", wide=True, big=True)
write_xml(xml(), grid, "vtk_raw_zlib.vtu", compressor="zlib")
write_xml(xml(), grid, "vtk_base64.vtu", base64=True)
write_xml(xml(), grid, "vtk_base64_lz4.vtu", compressor="lz4", base64=True)
write_xml(xml(), grid, "lzma.refused", compressor="lzma")
write_xml(vtk.vtkXMLImageDataWriter(), image(), "vtk_raw_lz4.vti", compressor="lz4")
write_xml(vtk.vtkXMLRectilinearGridWriter(), rectilinear(), "vtk_raw.vtr")
write_xml(vtk.vtkXMLStructuredGridWriter(), structured(), "vtk_base64_zlib.vts", compressor="zlib", base64=True)
write_legacy(vtk.vtkUnstructuredGridWriter(), grid, "vtk_ascii_5.vtk", False)
write_legacy(vtk.vtkUnstructuredGridWriter(), grid, "vtk_binary_5.vtk", True)
write_legacy(vtk.vtkUnstructuredGridWriter(), grid, "vtk_binary_4.vtk", True, 42)
write_legacy(vtk.vtkStructuredPointsWriter(), image(), "vtk_image.vtk", True)
write_legacy(vtk.vtkRectilinearGridWriter(), rectilinear(), "vtk_rectilinear.vtk", True)
write_legacy(vtk.vtkStructuredGridWriter(), structured(), "vtk_structured.vtk", False)

hexahedra = meshio.Mesh(corners, [("hexahedron", [[first + i for i in cube] for first in firsts])], values(corners))
hexahedra.write("meshio.vtu")
hexahedra.write("meshio_ascii.vtu", binary=False, compression=None)
hexahedra.write("meshio_42.vtk", file_format="vtk42")
hexahedra.write("meshio_51.vtk", file_format="vtk51")


def halves(data):
    """The cells on either side of x = ½, as two grids."""
    for side in range(2):
        cells = vtk.vtkIdList()
        for i in range(data.GetNumberOfCells()):
            bounds = data.GetCell(i).GetBounds()
            if data.GetCell(i).GetCellDimension() == 3 and (bounds[0] + bounds[1] > 1) == bool(side):
                cells.InsertNextId(i)
        extract = vtk.vtkExtractCells()
        extract.SetInputData(data)
        extract.SetCellList(cells)
        extract.Update()
        yield extract.GetOutput()


def write_parallel(writer, source, name):
    """Writes what two processes of a parallel program would write."""
    writer.SetInputConnection(source.GetOutputPort())
    writer.SetFileName(name)
    writer.SetNumberOfPieces(2)
    writer.SetStartPiece(0)
    writer.SetEndPiece(1)
    assert writer.Write() == 1


def read(reader, name):
    reader.SetFileName(name)
    return reader


# Lists of files, in a folder of their own, because the parts alone are half a cube.
os.makedirs("lists", exist_ok=True)
os.chdir("lists")
write_parallel(vtk.vtkXMLPImageDataWriter(), read(vtk.vtkXMLImageDataReader(), "../vtk_raw_lz4.vti"), "image.pvti")
rows = read(vtk.vtkXMLRectilinearGridReader(), "../vtk_raw.vtr")
write_parallel(vtk.vtkXMLPRectilinearGridWriter(), rows, "rectilinear.pvtr")
bent = read(vtk.vtkXMLStructuredGridReader(), "../vtk_base64_zlib.vts")
write_parallel(vtk.vtkXMLPStructuredGridWriter(), bent, "structured.pvts")
pieces = vtk.vtkExtractUnstructuredGridPiece()
pieces.SetInputData(grid)
write_parallel(vtk.vtkXMLPUnstructuredGridWriter(), pieces, "parallel.pvtu")
blocks, inner = vtk.vtkMultiBlockDataSet(), vtk.vtkMultiBlockDataSet()
first, second = halves(grid)
surface = vtk.vtkDataSetSurfaceFilter()
surface.SetInputData(grid)
surface.Update()
inner.SetBlock(0, second)
inner.SetBlock(1, None)
blocks.SetBlock(0, first)
blocks.SetBlock(1, inner)
blocks.SetBlock(2, surface.GetOutput())
writer = vtk.vtkXMLMultiBlockDataWriter()
writer.SetInputData(blocks)
writer.SetFileName("blocks.vtm")
assert writer.Write() == 1
