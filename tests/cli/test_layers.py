# SPDX-License-Identifier: MIT
"""Debug layers that a plugin states: listed, shown, left out while nobody looks."""
import json
import os

from harness import fails, main, read_pfm, succeeds

ARGS = ['cornell', '--size', '6x4', '--gi', 'layered']
DARK, GREEN = (0, 0, 0), (0.25, 1, 0.5)


def rows(path):
    width, height, values = read_pfm(path)
    pixels = [values[i:i + 3] for i in range(0, len(values), 3)]
    return width, height, [pixels[y * width:(y + 1) * width] for y in range(height)]


def layers_are_listed(folder):
    text = succeeds('plugins').out
    assert '--layer layered.half' in text and "of the frame's size" in text
    plugins = {p['name']: p for p in json.loads(succeeds('plugins', '--json').out)}
    assert [p['name'] for p in plugins['layered']['layers']] == ['half', 'wide', 'absent', 'odd']
    assert plugins['layered']['layers'][0]['help'] == "of the frame's size"


def a_layer_is_written_at_its_own_size(folder):
    for name, size in [('half', (6, 4)), ('wide', (18, 8))]:
        for layer in [name, 'layered.' + name]:
            path = '%s/%s.pfm' % (folder, layer)
            succeeds('render', *ARGS, '--layer', layer, '-o', path)
            width, height, pixels = rows(path)
            assert (width, height) == size
            # A PFM begins with the bottom row, which is the one that is lit.
            assert all(p == GREEN for p in pixels[0])
            assert all(p == DARK for row in pixels[1:] for p in row)
        succeeds('render', *ARGS, '--layer', name, '-o', folder + '/a.png', '--stats', folder + '/s.json')
        with open(folder + '/s.json') as f:
            passes = [p['name'] for p in json.load(f)['passes']]
        assert 'layered.' + name in passes and 'gbuffer.draw' not in passes, passes


def a_layer_that_nobody_asks_for_costs_nothing(folder):
    graph = json.loads(succeeds('graph', *ARGS, '--format', 'json').out)
    names = ['layered.' + name for name in ['half', 'wide', 'odd']]
    assert not any(p['name'].startswith('layered.') for p in graph['passes']), graph
    assert set(names) <= {p['pass'] for p in graph['left_out']}, graph
    assert not any(r['used'] for r in graph['resources'] if r['name'] in names), graph


def layers_that_are_not_there_are_refused(folder):
    path = folder + '/a.png'
    for layer in ['beauty', 'rsm.half', 'layered.', 'layered', '.half', 'layered.normal']:
        fails(2, ['--layer', "'%s'" % layer, 'final, radiance', 'layered.half, layered.wide'], 'render', *ARGS,
              '--layer', layer, '-o', path)
    fails(2, ['layered.half'], 'render', 'cornell', '--gi', 'rsm', '--layer', 'layered.half', '-o', path)
    fails(2, ['half'], 'render', 'cornell', '--layer', 'half', '-o', path)
    fails(1, ['layered.absent', 'not there'], 'render', *ARGS, '--layer', 'absent', '-o', path)
    fails(1, ['layered.odd', 'RGBA16F'], 'render', *ARGS, '--layer', 'odd', '-o', path)
    fails(2, ['half', '--gi rsm'], 'sequence', *ARGS, '--gi', 'rsm', '--layer', 'half', '--frames', 2, '-o',
          folder + '/s')
    assert not os.path.exists(path)


def a_sequence_takes_a_layer(folder):
    common = ['sequence', *ARGS, '--frames', 3, '--format', 'pfm']
    succeeds(*common, '--layer', 'wide', '-o', folder)
    for i in range(3):
        width, height, pixels = rows('%s/frame_%04d.pfm' % (folder, i))
        assert (width, height) == (18, 8) and pixels[0][17] == GREEN and pixels[1][0] == DARK
    # Plugins in turns: the layer is the host's, which both have.
    succeeds(*common, '--gi', 'none', '--layer', 'albedo', '-o', folder)
    assert rows(folder + '/frame_0000.pfm') == rows(folder + '/frame_0001.pfm')


if __name__ == '__main__':
    main([layers_are_listed, a_layer_is_written_at_its_own_size, a_layer_that_nobody_asks_for_costs_nothing,
          layers_that_are_not_there_are_refused, a_sequence_takes_a_layer])
