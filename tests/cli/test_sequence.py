# SPDX-License-Identifier: MIT
"""Plugins that take turns, frame by frame, in one process."""
from harness import main, succeeds

COMMON = ['sequence', 'cornell', '--camera', 'path', '--format', 'pfm', '--layer', 'radiance', '--size', '16x12',
          '--shadow-size', 64]
SMALL = {
    'none': [], 'rsm': ['rsm_size=32', 'vpls=64'], 'isr': ['rsm_size=32'], 'hisr': ['rsm_size=32'],
    'iir': ['max_lights=16', 'map_size=16'], 'splat': ['rsm_size=32', 'vpls=64'],
}


def frames(folder, name, count, *plugins):
    """Contents of the frames of a sequence, in order."""
    path = '%s/%s' % (folder, name)
    chosen = [word for plugin in plugins for word in ('--gi', plugin)]
    chosen += [word for plugin in plugins for value in SMALL[plugin] for word in ('--set', plugin + '.' + value)]
    succeeds(*COMMON, '--frames', count, *chosen, '-o', path)
    contents = []
    for i in range(count):
        with open('%s/frame_%04d.pfm' % (path, i), 'rb') as f:
            contents.append(f.read())
    return contents


def each_frame_is_that_of_the_plugin_alone(folder):
    # Of plugins that keep nothing from frame to frame a frame depends on its time alone.
    plugins = ['none', 'rsm', 'isr', 'hisr', 'splat']
    count = 2 * len(plugins) + 1
    turns = frames(folder, 'turns', count, *plugins)
    for k, plugin in enumerate(plugins):
        alone = frames(folder, 'alone', count, plugin)
        assert len(set(alone)) == count  # the camera moves
        for i in range(k, count, len(plugins)):
            assert turns[i] == alone[i], (plugin, i)


def a_plugin_with_a_state_begins_anew_at_each_turn(folder):
    # So its frames do not depend on who had the turns between.
    first = frames(folder, 'a', 5, 'iir', 'none')
    second = frames(folder, 'b', 5, 'iir', 'splat')
    alone = frames(folder, 'c', 1, 'iir')
    assert first[0] == alone[0]
    assert first[0::2] == second[0::2]
    assert first[1] != second[1]


if __name__ == '__main__':
    main([each_frame_is_that_of_the_plugin_alone, a_plugin_with_a_state_begins_anew_at_each_turn])
