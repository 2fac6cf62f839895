# SPDX-License-Identifier: MIT
"""What a recording by apitrace shows of a headless run: passes, resources, programs, frames."""
import json
import os
import re
import shutil
import subprocess
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from harness import BINARY, main, succeeds  # noqa: E402


def record(folder, *words):
    """The calls of a run, a line each, and how many frames there are."""
    assert shutil.which('apitrace'), 'apitrace is needed for this test'
    path = folder + '/calls.trace'
    env = {**os.environ, 'LD_PRELOAD': os.environ['EPOXY_WITHOUT_GLX']}
    subprocess.run(['apitrace', 'trace', '--api', 'egl', '-o', path, BINARY, *words], env=env, check=True,
                   timeout=100, stdout=subprocess.DEVNULL)
    calls = subprocess.run(['apitrace', 'dump', '--color=never', path], check=True, timeout=100,
                           capture_output=True, text=True).stdout
    info = subprocess.run(['apitrace', 'info', path], check=True, timeout=100, capture_output=True, text=True)
    return calls.splitlines(), json.loads(info.stdout)['FramesCount']


def a_recording_is_told_in_the_names_of_the_graph(folder):
    words = ['cornell', '--gi', 'isr', '--size', '32x32']
    graph = json.loads(succeeds('graph', *words, '--format', 'json').out)
    passes = [p['name'] for p in graph['passes']]
    calls, frames = record(folder, 'render', *words, '--frame', '2', '-o', folder + '/a.png')
    assert frames == 3, frames
    shown = [re.search(r'message = "([^"]+)"', c)[1] for c in calls if ' glPushDebugGroup(' in c]
    assert shown == 3 * passes, (shown, passes)
    depth = 0
    for call in calls:
        depth += (' glPushDebugGroup(' in call) - (' glPopDebugGroup(' in call)
        assert 0 <= depth <= 1, call
        # All drawing and computing lies in a pass.
        assert depth == 1 or not re.search(r' gl(Draw|Dispatch|MultiDraw)', call), call
    assert depth == 0
    labels = {kind: {m[1] for m in re.finditer(r'identifier = %s, .*label = "([^"]+)"' % kind, '\n'.join(calls))}
              for kind in ['GL_TEXTURE', 'GL_BUFFER', 'GL_PROGRAM']}
    used = {r['name'] for r in graph['resources'] if r.get('memory') == 'transient'}
    textures = {r['name'] for r in graph['resources'] if r['name'] in used and not r['shape'].endswith(' bytes')}
    # Textures that share memory share a name or are views with their own.
    assert 'gbuffer.normal' in labels['GL_TEXTURE'] and labels['GL_TEXTURE'] & textures, labels
    assert len(labels['GL_TEXTURE'] & textures) >= len(textures) // 3, (labels, textures)
    assert labels['GL_BUFFER'], labels
    assert any(name.startswith('passes/gbuffer/') or name.startswith('passes/gpu_scene/')
               for name in labels['GL_PROGRAM']), labels


if __name__ == '__main__':
    main([a_recording_is_told_in_the_names_of_the_graph])
