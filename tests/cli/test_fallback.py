# SPDX-License-Identifier: MIT
"""A plugin that fails once it runs: one warning, and direct light in the same frame."""
import json
import os

from harness import fails, main, succeeds

MODULES = ['--plugin-dir', os.environ['FAULTY_PLUGINS']]
SCENE = ['cornell', '--size', '12x8']
WHY = {
    'broken': "pass 'broken.fill' reads version 1 of 'broken.indirect', which it writes itself",
    'updateless': 'failed in update',
    'failing': "pass 'failing.fill' failed",
    'reaching': "asks for version 1 of 'gbuffer.normal', which it did not declare",
    'late': "pass 'late.fill' failed",
    'unstarted': 'failed to start: unstarted: it is too cold',
}


def content(path):
    with open(path, 'rb') as f:
        return f.read()


def direct(folder, frame=0):
    path = folder + '/direct.pfm'
    succeeds('render', *SCENE, '--frame', frame, '--layer', 'radiance', '-o', path)
    return content(path)


def warned(run, name):
    warnings = run.lines('warning')
    assert len(warnings) == 1, run
    for words in ["plugin '%s'" % name, WHY[name], 'direct light alone']:
        assert words in warnings[0], (words, str(run))


def direct_light_goes_on(folder):
    path, stats = folder + '/a.pfm', folder + '/a.json'
    for name in WHY:
        frame = 3 if name == 'late' else 0
        run = succeeds('render', *SCENE, *MODULES, '--gi', name, '--frame', frame, '--layer', 'radiance', '--stats',
                       stats, '-o', path)
        warned(run, name)
        assert content(path) == direct(folder, frame), name
        with open(stats) as f:
            record = json.load(f)
        assert record['plugin'] == 'none' and record['params'] == {}, record
        assert not any(p['name'].startswith(name) for p in record['passes']), record


def a_failure_while_frames_are_timed_is_told_of(folder):
    # The picture is of the frame before: the plugin's. The figures are of direct light.
    stats = folder + '/a.json'
    run = succeeds('render', *SCENE, *MODULES, '--gi', 'late', '--stats', stats, '-o', folder + '/a.pfm')
    warned(run, 'late')
    with open(stats) as f:
        record = json.load(f)
    assert record['plugin'] == 'none', record
    assert not any(p['name'].startswith('late') for p in record['passes']), record


def the_graph_is_that_of_direct_light(folder):
    run = succeeds('graph', *SCENE, *MODULES, '--gi', 'reaching')
    warned(run, 'reaching')
    assert 'reaching.fill' not in run.out and 'direct.light' in run.out, run


def its_layers_are_not_there(folder):
    for name in WHY:
        frame = 3 if name == 'late' else 0
        run = fails(1, ['layer', 'is not there'], 'render', *SCENE, *MODULES, '--gi', name, '--frame', frame, '--layer',
                    name + '.light', '-o', folder + '/a.pfm')
        warned(run, name)
        assert not os.path.exists(folder + '/a.pfm')


def in_a_sequence_the_others_go_on(folder):
    sequence = ['sequence', *SCENE, *MODULES, '--frames', 6, '--format', 'pfm', '--layer', 'radiance']
    succeeds(*sequence, '--gi', 'sound', '-o', folder + '/sound')
    for name in WHY:
        both = ['--gi', name, '--gi', 'sound']
        if name == 'late':  # each turn is its first frame
            succeeds(*sequence, *both, '-o', folder + '/b')
            run = succeeds(*sequence, '--gi', name, '-o', folder + '/b')
        else:
            run = succeeds(*sequence, *both, '-o', folder + '/b')
        warned(run, name)
        assert content(folder + '/b/frame_0004.pfm') == direct(folder, 4), name
        for frame in [] if name == 'late' else [1, 3, 5]:
            picture = '/frame_%04d.pfm' % frame
            assert content(folder + '/b' + picture) == content(folder + '/sound' + picture), (name, frame)


def figures_are_not_taken_of_what_failed(folder):
    fails(1, ['cases failed'], 'stability', 'slivers_and_backs', *MODULES, '--gi', 'failing', '-o', folder)
    fails(1, ["'failing.fill'"], 'report', 'cornell', '--size', '8x8', '--spp', 1, *MODULES, '--gi', 'failing', '-o',
          folder)


if __name__ == '__main__':
    main([direct_light_goes_on, a_failure_while_frames_are_timed_is_told_of, the_graph_is_that_of_direct_light,
          its_layers_are_not_there, in_a_sequence_the_others_go_on, figures_are_not_taken_of_what_failed])
