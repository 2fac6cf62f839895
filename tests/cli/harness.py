# SPDX-License-Identifier: MIT
"""Runs the afterglow command and counts what it was expected to do."""
import base64
import json
import os
import struct
import subprocess
import sys
import tempfile
import traceback

BINARY = os.environ['AFTERGLOW']


class Run:
    def __init__(self, args, env=None, **streams):
        streams = {'stdout': subprocess.PIPE, 'stderr': subprocess.PIPE, 'stdin': subprocess.DEVNULL, **streams}
        done = subprocess.run([BINARY, *map(str, args)], env={**os.environ, **(env or {})}, timeout=300, **streams)
        self.code, self.args = done.returncode, args
        self.out = (done.stdout or b'').decode(errors='replace')
        self.err = (done.stderr or b'').decode(errors='replace')

    def lines(self, kind):
        return [line for line in self.err.splitlines() if line.startswith('afterglow: ' + kind + ': ')]

    def __str__(self):
        return '%s -> %d\n%s%s' % (' '.join(map(str, self.args)), self.code, self.out[-500:], self.err[-500:])


def succeeds(*args, env=None):
    run = Run(args, env)
    assert run.code == 0, run
    assert not run.lines('error'), run
    return run


def fails(code, words, *args, env=None):
    """Exit code, exactly one error line, and the words that it must hold."""
    run = Run(args, env)
    assert run.code == code, run
    errors = run.lines('error')
    assert len(errors) == 1, run
    what = errors[0].split(': ', 2)
    assert len(what) == 3 and ': ' in what[2], run
    for word in words:
        assert word in errors[0], (word, str(run))
    return run


def read_pfm(path):
    with open(path, 'rb') as f:
        assert f.readline() == b'PF\n'
        width, height = map(int, f.readline().split())
        assert float(f.readline()) < 0
        data = f.read()
    return width, height, struct.unpack('<%df' % (3 * width * height), data)


def write_triangle(path):
    """A .gltf file of one triangle, without camera, light or motion."""
    corners = base64.b64encode(struct.pack('<9f', -1, -1, 0, 1, -1, 0, 0, 1, 0)).decode()
    with open(path, 'w') as f:
        json.dump({
            'asset': {'version': '2.0'}, 'scene': 0, 'scenes': [{'nodes': [0]}], 'nodes': [{'mesh': 0}],
            'meshes': [{'primitives': [{'attributes': {'POSITION': 0}}]}],
            'buffers': [{'uri': 'data:application/octet-stream;base64,' + corners, 'byteLength': 36}],
            'bufferViews': [{'buffer': 0, 'byteLength': 36}],
            'accessors': [{'bufferView': 0, 'componentType': 5126, 'count': 3, 'type': 'VEC3',
                           'min': [-1, -1, 0], 'max': [1, 1, 0]}]}, f)


def main(tests):
    """Runs the functions with an empty folder each and exits 1 if any raises."""
    failed = 0
    for test in tests:
        with tempfile.TemporaryDirectory() as folder:
            try:
                test(folder)
                print('ok   ', test.__name__)
            except Exception:
                failed += 1
                print('FAIL ', test.__name__)
                traceback.print_exc(file=sys.stdout)
    print('%d passed, %d failed' % (len(tests) - failed, failed))
    sys.exit(1 if failed else 0)
