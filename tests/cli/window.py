# SPDX-License-Identifier: MIT
"""The viewer in a window of its own, and a user in front of it."""
import json
import os
import re
import subprocess
import time

from harness import BINARY


class Screen:
    """An X server of its own, on a free display."""

    def __init__(self, width=900, height=700):
        self.size = '%dx%dx24' % (width, height)

    def __enter__(self):
        read, write = os.pipe()
        self.server = subprocess.Popen(
            ['Xvfb', '-displayfd', str(write), '-screen', '0', self.size, '-dpi', '96', '-nolisten', 'tcp'],
            pass_fds=[write], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(write)
        with os.fdopen(read) as f:
            number = f.readline().strip()
        assert number, 'Xvfb does not start'
        self.env = {'DISPLAY': ':' + number}
        return self

    def __exit__(self, *_):
        self.server.terminate()
        self.server.wait()


class Viewer:
    def __init__(self, screen, folder, *args):
        self.env = {**os.environ, **screen.env}
        self.folder, self.path = folder, folder + '/stderr'
        self.file = open(self.path, 'wb')
        self.process = subprocess.Popen([BINARY, 'view', '--verbose', '-o', folder, *map(str, args)],
                                        env=self.env, stderr=self.file, stdin=subprocess.DEVNULL)
        self.seen = 0

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.kill()
            self.process.wait()
        self.file.close()

    def text(self):
        with open(self.path, errors='replace') as f:
            return f.read()

    def wait(self, pattern, seconds=60):
        """The first new match; what stands before it counts as seen."""
        end = time.monotonic() + seconds
        while True:
            match = re.compile(pattern).search(self.text(), self.seen)
            if match:
                self.seen = match.end()
                return match
            assert self.process.poll() is None and time.monotonic() < end, (pattern, self.text())
            time.sleep(0.02)

    def do(self, *words):
        subprocess.run(['xdotool', *map(str, words)], env=self.env, check=True, timeout=30)

    def key(self, key, pattern):
        self.do('key', key)
        return self.wait(pattern)

    def shot(self, key='F6'):
        return self.key(key, r'wrote (.*\.png)\n').group(1)

    def saved(self):
        with open(self.key('F7', r'saved (.*)\n').group(1)) as f:
            return json.load(f)

    def quits(self):
        self.do('key', 'ctrl+q')
        assert self.process.wait(60) == 0, self.text()
        assert 'afterglow: error' not in self.text(), self.text()
        assert ' 0 OpenGL errors' in self.text(), self.text()
