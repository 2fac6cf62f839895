# SPDX-License-Identifier: MIT
"""From the start of `afterglow view` to its first frames, without anything cached, in seconds.

view_first_frame: direct light and the panel; view_first_plugin: with hisr, whose shaders compile after that.
"""
import json
import os
import statistics
import sys
import tempfile
import time

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', 'cli'))
from harness import succeeds  # noqa: E402
from window import Screen, Viewer  # noqa: E402

SIZE, RUNS = '1280x720', 3


def measure(screen, scene):
    with tempfile.TemporaryDirectory() as folder:
        start = time.monotonic()
        with Viewer(screen, folder, scene, '--size', SIZE) as viewer:
            viewer.wait('first frame after', 120)
            first = time.monotonic() - start
            viewer.wait('first frame with', 120)
            plugin = time.monotonic() - start
            viewer.quits()
    return first, plugin


os.environ['MESA_SHADER_CACHE_DISABLE'] = 'true'
os.environ['__GL_SHADER_DISK_CACHE'] = '0'
with Screen(1400, 800) as on:
    for name in [s['name'] for s in json.loads(succeeds('scenes', '--json').out)]:
        times = [measure(on, name) for _ in range(RUNS)]
        for i, figure in enumerate(['view_first_frame', 'view_first_plugin']):
            print('BENCH %s %s %s %.3f s' % (figure, name, SIZE, statistics.median(t[i] for t in times)), flush=True)
