# SPDX-License-Identifier: MIT
"""What the commands print and write: pictures, JSON, figures."""
import json
import os
import struct
import subprocess

from harness import main, read_pfm, succeeds

METRICS = ['rmse', 'rmse_rms', 'rmse_max', 'relmse', 'smape', 'bias', 'energy_ratio', 'p99', 'nonfinite']


def write_pfm(path, values):
    with open(path, 'wb') as f:
        f.write(b'PF\n%d 1\n-1.0\n' % (len(values) // 3) + struct.pack('<%df' % len(values), *values))


def compare_gives_the_figures_that_were_worked_out(folder):
    a, b = folder + '/a.pfm', folder + '/b.pfm'
    write_pfm(a, [1, 2, 3, 4, 5, 6])
    write_pfm(b, [1, 2, 3, 4, 5, 8])
    m = json.loads(succeeds('compare', a, b, '--json').out)
    for name in METRICS:
        assert isinstance(m[name], (int, float)), name
    rms = ((1 + 4 + 9 + 16 + 25 + 64) / 6) ** 0.5
    expected = {'rmse': (4 / 6) ** 0.5, 'rmse_rms': (4 / 6) ** 0.5 / rms, 'rmse_max': (4 / 6) ** 0.5 / 8,
                'smape': 2 * 2 / 14 / 6, 'bias': -2 / 6, 'energy_ratio': 21 / 23, 'nonfinite': 0}
    for name, value in expected.items():
        assert abs(m[name] - value) < 1e-6, (name, m[name], value)
    same = json.loads(succeeds('compare', b, b, '--json').out)
    assert same['rmse'] == 0 and same['energy_ratio'] == 1
    text = succeeds('compare', a, b).out
    assert all(any(line.split()[0] == name for line in text.splitlines()) for name in METRICS)


def pixels_that_are_not_finite_are_counted(folder):
    a, b = folder + '/a.pfm', folder + '/b.pfm'
    write_pfm(a, [1, 2, 3, float('nan'), 5, 6])
    write_pfm(b, [1, 2, 3, 4, 5, 6])
    m = json.loads(succeeds('compare', a, b, '--json').out)
    assert m['nonfinite'] == 1 and m['rmse'] == 0


def the_same_frame_is_the_same_bits(folder):
    for ending in ['png', 'pfm', 'exr']:
        paths = ['%s/%d.%s' % (folder, i, ending) for i in range(2)]
        for path in paths:
            succeeds('render', 'cornell', '--gi', 'rsm', '--size', '64x64', '--set', 'vpls=64', '-o', path)
        assert open(paths[0], 'rb').read() == open(paths[1], 'rb').read(), ending


def debug_switches_change_nothing(folder):
    plain = folder + '/plain.pfm'
    common = ['render', 'cornell', '--gi', 'rsm', '--size', '32x32', '--layer', 'radiance']
    succeeds(*common, '-o', plain)
    for switches in ['poison', 'no-sharing', 'random-order', 'poison,no-sharing,random-order']:
        other = folder + '/other.pfm'
        succeeds(*common, '--debug', switches, '-o', other)
        assert open(plain, 'rb').read() == open(other, 'rb').read(), switches


def odd_sizes_are_rendered(folder):
    for width, height in [(1, 1), (3, 5), (1023, 517)]:
        path = folder + '/a.pfm'
        succeeds('render', 'cornell', '--gi', 'rsm', '--set', 'vpls=64', '--size', '%dx%d' % (width, height),
                 '--layer', 'radiance', '-o', path)
        w, h, values = read_pfm(path)
        assert (w, h) == (width, height)
        assert all(0 <= v < 1e6 for v in values)
    assert os.listdir(folder) == ['a.pfm']


def every_layer_can_be_had(folder):
    for layer in ['final', 'radiance', 'direct', 'indirect', 'albedo', 'normal', 'position']:
        for ending in ['png', 'exr', 'pfm']:
            path = '%s/%s.%s' % (folder, layer, ending)
            succeeds('render', 'cornell', '--gi', 'rsm', '--set', 'vpls=16', '--size', '8x8', '--layer', layer,
                     '-o', path)
            assert os.path.getsize(path) > 0
    parts = [read_pfm('%s/%s.pfm' % (folder, name))[2] for name in ['radiance', 'direct', 'indirect']]
    # Half floats stand between: 2^-11 of the value.
    assert all(abs(r - d - i) <= 1e-3 * r + 1e-6 for r, d, i in zip(*parts))


def stats_have_the_shape_that_is_promised(folder):
    stats = folder + '/s.json'
    succeeds('render', 'cornell', '--gi', 'rsm', '--set', 'vpls=64', '--size', '32x16', '-o', folder + '/a.png',
             '--stats', stats, '--timing-frames', 2)
    with open(stats) as f:
        s = json.load(f)
    assert s['device']['renderer'] and s['device']['version']
    assert s['scene'] == 'cornell' and s['size'] == [32, 16] and s['plugin'] == 'rsm'
    rsm = [p for p in json.loads(succeeds('plugins', '--json').out) if p['name'] == 'rsm'][0]
    expected = {p['name']: p['default'] for p in rsm['params']}
    expected['vpls'] = 64
    assert s['params'] == expected
    assert 0 < s['frame_ms']['min'] <= s['frame_ms']['median'] <= s['frame_ms']['p99']
    assert s['cpu_ms']['median'] > 0
    names = [p['name'] for p in s['passes']]
    assert 'rsm.gather' in names and 'gbuffer.draw' in names
    assert all(isinstance(p['gpu_ms'], (int, float)) for p in s['passes'])
    assert s['counters']['vpls'] > 0
    for name in ['transient_bytes', 'unshared_bytes', 'persistent_bytes']:
        assert isinstance(s['memory'][name], (int, float)), name
    assert 0 < s['memory']['transient_bytes'] <= s['memory']['unshared_bytes']
    assert all(entry['pass'] and entry['why'] for entry in s['left_out'])
    assert 'error' in s


def a_sequence_takes_turns(folder):
    out = folder + '/frames'
    succeeds('sequence', 'cornell', '--gi', 'none', '--gi', 'rsm', '--set', 'rsm.vpls=16', '--frames', 4, '--size',
             '16x16', '--format', 'pfm', '--layer', 'radiance', '-o', out)
    assert sorted(os.listdir(out)) == ['frame_%04d.pfm' % i for i in range(4)]
    frames = [open('%s/frame_%04d.pfm' % (out, i), 'rb').read() for i in range(4)]
    assert len(set(frames)) == 4
    for frame, plugin in enumerate(['none', 'rsm', 'none', 'rsm']):
        path = folder + '/one.pfm'
        extra = ['--set', 'vpls=16'] if plugin == 'rsm' else []
        succeeds('render', 'cornell', '--gi', plugin, *extra, '--frame', frame, '--size', '16x16', '--layer', 'radiance',
                 '-o', path)
        assert open(path, 'rb').read() == frames[frame], frame


def a_pipe_gets_the_whole_of_it(folder):
    pipe = folder + '/pipe'
    os.mkfifo(pipe)
    with subprocess.Popen(['cat', pipe], stdout=subprocess.PIPE) as reader:
        succeeds('render', 'cornell', '--size', '8x8', '-o', folder + '/a.png', '--stats', pipe)
        assert json.loads(reader.communicate(timeout=60)[0])['scene'] == 'cornell'


def frame_n_is_the_nth_of_a_sequence(folder):
    out, path = folder + '/frames', folder + '/one.pfm'
    common = ['--size', '24x16', '--layer', 'direct']
    succeeds('sequence', 'atrium', '--frames', 3, '--format', 'pfm', *common, '-o', out)
    succeeds('render', 'atrium', '--frame', 2, *common, '-o', path)
    assert open(path, 'rb').read() == open(out + '/frame_0002.pfm', 'rb').read()


def the_reference_depends_on_the_seed_alone(folder):
    def trace(name, *extra):
        path = '%s/%s.pfm' % (folder, name)
        succeeds('reference', 'cornell', '--size', '16x16', '--spp', 4, *extra, '-o', path)
        return open(path, 'rb').read()
    assert trace('a', '--seed', 3, '--threads', 1) == trace('b', '--seed', 3, '--threads', 2)
    assert trace('a', '--seed', 3) != trace('b', '--seed', 4)


def direct_light_is_that_of_the_reference(folder):
    a, b = folder + '/a.pfm', folder + '/b.pfm'
    succeeds('render', 'cornell', '--layer', 'direct', '--size', '128x128', '-o', a)
    succeeds('reference', 'cornell', '--bounces', 0, '--layer', 'direct', '--spp', 1, '--size', '128x128', '-o', b)
    m = json.loads(succeeds('compare', a, b, '--json').out)
    # Shadow edges are a texel wide, and a larger part of a small picture: 0.5 % of the mean.
    assert abs(m['energy_ratio'] - 1) < 0.005, m


def shadow_maps_and_their_filter_are_chosen(folder):
    def picture(*extra):
        path = folder + '/a.pfm'
        succeeds('render', 'cornell', '--layer', 'direct', '--size', '64x64', *extra, '-o', path)
        return open(path, 'rb').read()
    plain = picture()
    assert picture('--shadow-size', 2048, '--shadow-taps', 4) == plain
    assert picture('--shadow-taps', 16) != plain
    assert picture('--shadow-size', 64) != plain
    graph = json.loads(succeeds('graph', 'cornell', '--shadow-size', 64, '--format', 'json').out)
    shapes = [r['shape'] for r in graph['resources'] if r['name'] == 'shadow.maps']
    assert shapes and all(shape.startswith('DEPTH32F 64x64') for shape in shapes), shapes


def the_graph_is_printed_in_every_format(folder):
    common = ['graph', 'cornell', '--gi', 'rsm', '--size', '16x16']
    text = succeeds(*common).out
    assert 'rsm.gather' in text and 'left out' in text
    assert succeeds(*common, '--format', 'dot').out.lstrip().startswith('digraph')
    json.loads(succeeds(*common, '--format', 'json').out)
    json.loads(succeeds(*common, '--format', 'trace').out)
    succeeds(*common, '--needs', 'all')


def what_stability_asks_of_iir_is_there(folder):
    # Rows for VPLs that are kept go by names: without one they would not be served, and nobody would see.
    iir = [p for p in json.loads(succeeds('plugins', '--json').out) if p['name'] == 'iir'][0]
    assert {p['name'] for p in iir['params']} >= {
        'mode', 'max_lights', 'recalc_min', 'recalc_max', 'delay', 'first', 'settle', 'visibility', 'map_size', 'tiles',
        'alpha', 'beta', 'clamp'}, iir
    assert [layer['name'] for layer in iir['layers']][0] == 'vpls'
    succeeds('render', 'cornell', '--gi', 'iir', '--set', 'map_size=16', '--size', '8x8', '-o', folder + '/a.png',
             '--stats', folder + '/s.json')
    with open(folder + '/s.json') as f:
        counters = json.load(f)['counters']
    assert {'vpls', 'escaped', 'shadow_maps', 'new_vpls', 'invalid', 'dispersion', 'manage_ms'} <= set(counters), counters
    assert counters['vpls'] + counters['escaped'] == 256


def plugins_scenes_and_info_are_json(folder):
    plugins = json.loads(succeeds('plugins', '--json').out)
    rsm = [p for p in plugins if p['name'] == 'rsm'][0]
    assert rsm['source'] and rsm['summary']
    for p in rsm['params']:
        assert p['type'] in ('int', 'float', 'bool', 'enum') and p['help'] and 'default' in p, p
        if p['type'] in ('int', 'float'):
            assert p['min'] <= p['default'] <= p['max'], p
    assert 'rsm' in succeeds('plugins').out
    scenes = json.loads(succeeds('scenes', '--json').out)
    names, text = [s['name'] for s in scenes], succeeds('scenes').out
    assert 'cornell' in names and 'atrium' in names
    for s in scenes:
        assert s['purpose'] in text and ', '.join(s['features']) in text and 'moving light' in s['features'], s
    assert json.loads(succeeds('info', 'cornell', '--json').out)['features'] == scenes[0]['features']
    info = json.loads(succeeds('info', 'cornell', '--json').out)
    assert info['triangles'] > 10 and 'light' in info['features'] and len(info['lights']) == 1
    devices = json.loads(succeeds('info', '--json').out)
    assert any(d['renderer'] for d in devices)


def a_scene_in_the_dark_gets_a_light_and_a_warning(folder):
    path = folder + '/dark.gltf'
    positions = struct.pack('<9f', -1, -1, 0, 1, -1, 0, 0, 1, 0)
    with open(folder + '/dark.bin', 'wb') as f:
        f.write(positions)
    with open(path, 'w') as f:
        json.dump({
            'asset': {'version': '2.0'}, 'scene': 0, 'scenes': [{'nodes': [0]}], 'nodes': [{'mesh': 0}],
            'materials': [{'pbrMetallicRoughness': {'metallicFactor': 0}}],
            'meshes': [{'primitives': [{'attributes': {'POSITION': 0}, 'material': 0}]}],
            'buffers': [{'uri': 'dark.bin', 'byteLength': len(positions)}],
            'bufferViews': [{'buffer': 0, 'byteLength': len(positions)}],
            'accessors': [{'bufferView': 0, 'componentType': 5126, 'count': 3, 'type': 'VEC3',
                           'min': [-1, -1, 0], 'max': [1, 1, 0]}]}, f)
    out = folder + '/a.pfm'
    run = succeeds('render', path, '--size', '16x16', '--layer', 'direct', '-o', out)
    assert any('has no light' in line for line in run.lines('warning')), run
    assert max(read_pfm(out)[2]) > 0.01
    with open(path) as f:
        glowing = json.load(f)
    glowing['materials'][0]['emissiveFactor'] = [1, 1, 1]
    with open(folder + '/glow.gltf', 'w') as f:
        json.dump(glowing, f)
    run = succeeds('render', folder + '/glow.gltf', '--size', '16x16', '-o', folder + '/c.png')
    assert len([line for line in run.lines('warning') if 'nothing shines but surfaces' in line]) == 1, run
    run = succeeds('render', path, '--size', '16x16', '--light', 'point:0,0,2:9,9,9', '-o', folder + '/b.png')
    assert not any('has no light' in line for line in run.lines('warning')), run


if __name__ == '__main__':
    main([compare_gives_the_figures_that_were_worked_out, pixels_that_are_not_finite_are_counted,
          the_same_frame_is_the_same_bits, debug_switches_change_nothing, odd_sizes_are_rendered,
          every_layer_can_be_had, stats_have_the_shape_that_is_promised, a_sequence_takes_turns,
          a_pipe_gets_the_whole_of_it, frame_n_is_the_nth_of_a_sequence, the_reference_depends_on_the_seed_alone,
          direct_light_is_that_of_the_reference, shadow_maps_and_their_filter_are_chosen, the_graph_is_printed_in_every_format,
          what_stability_asks_of_iir_is_there, plugins_scenes_and_info_are_json, a_scene_in_the_dark_gets_a_light_and_a_warning])
