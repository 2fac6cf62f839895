# SPDX-License-Identifier: MIT
"""The sample host with a context and a graph of its own: its drawing is as it set it, around a technique's light.

    test_host_own.py HOST_OWN
"""
import os
import subprocess
import sys
import tempfile

WIDTH, HEIGHT = 200, 160


def picture(folder, plugin):
    """Rows from the top, of pixels (r, g, b)."""
    path = os.path.join(folder, plugin + '.ppm')
    subprocess.run([sys.argv[1], path, plugin], check=True, timeout=60)
    with open(path, 'rb') as f:
        assert f.readline() == b'P6\n' and f.readline() == b'200 160\n' and f.readline() == b'255\n'
        data = f.read()
    assert len(data) == 3 * WIDTH * HEIGHT
    at = [tuple(data[i:i + 3]) for i in range(0, len(data), 3)]
    return [at[WIDTH * y:WIDTH * (y + 1)] for y in range(HEIGHT)]


def near(pixel, color):
    # 8 bits, rounded once for each of two colours.
    return all(abs(p - c) <= 1 for p, c in zip(pixel, color))


def check_canvas(rows):
    background, band = (64, 0, 64), (160, 128, 32)  # half of (255, 255, 0) over the background
    assert near(rows[0][0], background) and near(rows[-1][-1], background)
    assert near(rows[147][100], band), rows[147][100]
    assert near(rows[147][5], background) and near(rows[147][195], background)  # beyond the scissor box
    assert near(rows[10][100], background) and near(rows[80][15], background)
    # The picture stands upright: nothing above the wall, the floor at the bottom, as red as its material.
    assert rows[25][100] == (0, 0, 0)
    floor = rows[135][100]
    assert floor[0] > 1.2 * floor[1] > 0 and floor[1] == floor[2], floor


def main():
    with tempfile.TemporaryDirectory() as folder:
        rsm, splat = picture(folder, 'rsm'), picture(folder, 'splat')
    check_canvas(rsm)
    check_canvas(splat)
    # In the corner of floor and wall there is light that neither gets directly, much alike by both.
    here, there = rsm[98][100], splat[98][100]
    assert all(abs(a - b) < 40 for a, b in zip(here, there)), (here, there)
    assert rsm != splat


main()
