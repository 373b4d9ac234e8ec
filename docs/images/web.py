"""Draws web.png: two webs of the same size beside each other, on one scale of grey.

    spunlaid web cases/web_shared.toml
    spunlaid web cases/web_known.toml --set line.belt_speed="3 m/s" --set line.filaments_per_metre=auto \
      --set 'line.rows=[{ pitch = "0.2 mm", filaments = 2500 }]' --set web.width="0.5 m" --set web.length="0.5 m" \
      --out results/web_independent
    python docs/images/web.py results/web_shared/map.npy results/web_independent/map.npy docs/images/web.png

line_web.png is made in the same way with CELLS = 4: from the web of docs/line.md, and from its linear density, throughput, basis
weight, and the standard deviations and noise of its layer in summary.json, in a row with a pitch of 0.2 mm. line_cv.png is the
figure web_cv.png of the first of them.
"""

import array
import ast
import math
import struct
import sys
import zlib

GAP = 16
"""White columns between the webs [px]."""
CELLS = 2
"""Cells to a pixel, either way."""
LEVELS = 32
"""Levels of grey; more of them make the file larger and look the same."""


def read(path):
    """The rows of pixels of a map of 32-bit numbers."""
    with open(path, "rb") as file:
        head = file.read(10)
        shape = ast.literal_eval(file.read(struct.unpack("<H", head[8:])[0]).decode())["shape"]
        numbers = array.array("f", file.read())
    rows = [numbers[row * shape[1] : (row + 1) * shape[1]] for row in range(shape[0])]

    def pixel(row, column):
        cells = (rows[row + i][column + j] for i in range(CELLS) for j in range(CELLS))
        return math.fsum(cells) / CELLS**2

    columns = range(0, shape[1], CELLS)
    return [[pixel(row, column) for column in columns] for row in range(0, shape[0], CELLS)]


def main(first, second, picture):
    webs = [read(first), read(second)]
    pixels = [pixel for row in webs[0] for pixel in row]
    mean = math.fsum(pixels) / len(pixels)
    deviation = math.sqrt(math.fsum((pixel - mean) ** 2 for pixel in pixels) / len(pixels))

    def grey(pixel):
        # Three standard deviations of the first web either way from dark to light.
        level = 0.5 - (pixel - mean) / (6 * deviation)
        return round(round(min(max(level, 0), 1) * (LEVELS - 1)) * 255 / (LEVELS - 1))

    gap = bytes([255] * GAP)
    rows = [bytes(map(grey, one)) + gap + bytes(map(grey, other)) for one, other in zip(*webs, strict=True)]

    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    head = struct.pack(">IIBBBBB", len(rows[0]), len(rows), 8, 0, 0, 0, 0)
    lines = zlib.compress(b"".join(b"\0" + row for row in rows), 9)
    with open(picture, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", lines) + chunk(b"IEND", b""))


main(*sys.argv[1:])
