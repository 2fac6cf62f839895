# SPDX-License-Identifier: MIT
"""Wrong usage, refused input, and that neither leaves a file behind."""
import os
import struct

from harness import Run, fails, main, succeeds

COMMANDS = ['render', 'sequence', 'reference', 'compare', 'report', 'stability', 'graph', 'plugins',
            'scenes', 'info']


def help_is_there_for_every_command(folder):
    out = succeeds('--help').out
    for name in COMMANDS:
        assert '  %s ' % name in out, name
        assert 'usage: afterglow %s' % name in succeeds(name, '--help').out
    assert succeeds('--version').out.startswith('afterglow ')


def unknown_words_are_wrong_usage(folder):
    fails(2, ['command'])
    fails(2, ['command', 'empty'], '')
    fails(2, ['frobnicate', 'unknown command'], 'frobnicate')
    fails(2, ['--frobnicate', 'unknown option'], 'render', 'cornell', '--frobnicate')
    fails(2, ['--spp', 'unknown option'], 'render', 'cornell', '--spp', 1)
    fails(2, ['SCENE', 'missing'], 'render', '-o', folder + '/a.png')
    fails(2, ['atrium', 'too many'], 'render', 'cornell', 'atrium', '-o', folder + '/a.png')
    fails(2, ['-o', 'missing'], 'render', 'cornell')
    fails(2, ['--size', 'missing'], 'render', 'cornell', '-o', folder + '/a.png', '--size')
    assert os.listdir(folder) == []


def bad_values_name_option_value_and_rule(folder):
    picture = folder + '/a.png'
    for size in ['0x0', '70000x1', '64', '64x', 'x64', '-1x4', '64x64x64', '1e2x4', ' 4x4', '']:
        fails(2, ['--size', "'%s'" % size, 'must be'], 'render', 'cornell', '--size', size, '-o', picture)
    for frame in ['-1', 'one', '1.5', '99999999999999999999']:
        fails(2, ['--frame', frame, 'must be'], 'render', 'cornell', '--frame', frame, '-o', picture)
    fails(2, ['--exposure', 'nan'], 'render', 'cornell', '--exposure', 'nan', '-o', picture)
    fails(2, ['--seed', '-3'], 'render', 'cornell', '--seed', '-3', '-o', picture)
    fails(2, ['--layer', 'beauty'], 'render', 'cornell', '--layer', 'beauty', '-o', picture)
    fails(2, ['--debug', 'magic'], 'render', 'cornell', '--debug', 'magic', '-o', picture)
    fails(2, ['-o', '.jpg'], 'render', 'cornell', '-o', folder + '/a.jpg')
    fails(2, ['--layer', 'final'], 'reference', 'cornell', '--layer', 'final', '-o', picture)
    fails(2, ['--unshadowed-bounce'], 'reference', 'cornell', '--bounces', 0, '--unshadowed-bounce', '-o',
          picture)
    fails(2, ['--frames', 'missing'], 'sequence', 'cornell', '-o', folder + '/s')
    fails(2, ['--stats', 'a.png'], 'render', 'cornell', '-o', picture, '--stats', picture)
    fails(2, ['--gi', 'a name'], 'render', 'cornell', '--gi', '', '-o', picture)
    fails(3, ['--plugin-dir', 'no folder'], 'plugins', '--plugin-dir', folder + '/none')
    fails(3, ['--shader-dir', 'no folder'], 'render', 'cornell', '--shader-dir', folder + '/none', '-o', picture)
    fails(2, ['--format', 'xml'], 'graph', 'cornell', '--format', 'xml')
    fails(2, ['--budget', 'huge'], 'report', '--budget', 'huge', '-o', folder + '/r')
    fails(2, ['--study', 'stages, eye_depth', "'eye'"], 'report', '--study', 'eye', '-o', folder + '/r')
    fails(2, ['--shard', '3/2'], 'report', '--shard', '3/2', '-o', folder + '/r')
    for size in ['0', '8193', '-1', 'big', '']:
        fails(2, ['--shadow-size', "'%s'" % size, 'from 1 to 8192'], 'render', 'cornell', '--shadow-size', size, '-o',
              picture)
    for taps in ['0', '1', '5', '15', '17', '4x', '']:
        fails(2, ['--shadow-taps', "'%s'" % taps, 'must be 4 or 16'], 'graph', 'cornell', '--shadow-taps', taps)
    fails(2, ['--shadow-taps', 'unknown option'], 'reference', 'cornell', '--shadow-taps', 16, '-o', picture)
    fails(2, ['device is 60', 'must be'], 'render', 'cornell', '--size', '4x4', '--device', 60, '-o', picture)
    assert not os.path.exists(picture)


def plugins_and_parameters_are_checked(folder):
    picture = folder + '/a.png'
    common = ['render', 'cornell', '--size', '8x8', '-o', picture]
    fails(2, ['--gi', 'nonesuch'], *common, '--gi', 'nonesuch')
    fails(2, ['colour'], *common, '--gi', 'rsm', '--set', 'colour=1')
    fails(2, ['rsm_size', '100'], *common, '--gi', 'rsm', '--set', 'rsm_size=100')
    fails(2, ['vpls', '-5'], *common, '--gi', 'rsm', '--set', 'vpls=-5')
    fails(2, ['KEY=VALUE'], *common, '--gi', 'rsm', '--set', 'vpls')
    fails(2, ['vpls'], *common, '--set', 'vpls=16')
    fails(2, ['one plugin'], *common, '--gi', 'rsm', '--gi', 'none')
    assert not os.path.exists(picture)


def a_refused_module_leaves_direct_light(folder):
    with open(folder + '/gi_broken.so', 'w') as f:
        f.write('no module')
    a, b = folder + '/a.pfm', folder + '/b.pfm'
    run = succeeds('render', 'cornell', '--size', '16x16', '--layer', 'radiance', '--gi', 'broken',
                   '--plugin-dir', folder, '-o', a)
    assert any('gi_broken' in line or 'broken' in line for line in run.lines('warning')), run
    succeeds('render', 'cornell', '--size', '16x16', '--layer', 'radiance', '-o', b)
    assert open(a, 'rb').read() == open(b, 'rb').read()
    # Nobody knows the parameters of what cannot be loaded.
    succeeds('render', 'cornell', '--size', '16x16', '--layer', 'radiance', '--gi', 'broken', '--set', 'steps=3',
             '--plugin-dir', folder, '-o', a)
    assert open(a, 'rb').read() == open(b, 'rb').read()


def every_plugin_means_those_that_load(folder):
    with open(folder + '/gi_broken.so', 'w') as f:
        f.write('no module')
    run = succeeds('stability', 'no_light', '--plugin-dir', folder, '-o', folder)
    assert len([line for line in run.lines('warning') if 'broken' in line]) == 1, run
    columns = run.out.split('\n')[0].split()
    assert columns.count('none') == 1 and 'rsm' in columns and 'broken' not in columns, run


def scenes_that_are_missing_or_broken_are_refused(folder):
    picture = folder + '/a.png'
    fails(3, ['nowhere.gltf'], 'render', folder + '/nowhere.gltf', '-o', picture)
    fails(3, ['nosuchscene'], 'info', 'nosuchscene')
    for name, data in [('a.gltf', b'{ "asset": '), ('b.glb', b'glTF\x02\0\0\0\xff\xff\xff\xff'),
                       ('c.gltf', b''), ('d.gltf', b'{"asset":{"version":"2.0"},"scene":7}')]:
        with open(os.path.join(folder, name), 'wb') as f:
            f.write(data)
        fails(3, [name], 'render', os.path.join(folder, name), '-o', picture)
    fails(3, ['is a folder'], 'render', folder, '-o', picture)
    fails(3, ['no regular file'], 'render', '/dev/zero', '-o', picture)
    assert not os.path.exists(picture)


def cameras_and_lights_are_checked(folder):
    picture = folder + '/a.png'
    common = ['render', 'cornell', '--size', '8x8', '-o', picture]
    fails(2, ['--camera', 'sideways'], *common, '--camera', 'sideways')
    fails(2, ['--camera', '--camera-at'], *common, '--camera', 'front', '--camera-at', '0,0,0:1,1,1')
    for text in ['1,2,3', '1,2,3:1,2,3', '1,2:3,4,5', '0,0,0:1,1,1:0', '0,0,0:1,1,1:180', 'a,b,c:1,2,3']:
        fails(2, ['--camera-at', text], *common, '--camera-at', text)
    for text in ['lamp:0,0,0:1,1,1', 'point:0,0:1,1,1', 'point:0,0,0:-1,1,1', 'spot:0,0,0:0,0,0:1,1,1',
                 'spot:0,0,0:0,-1,0:1,1,1:50,20', 'spot:0,0,0:0,-1,0:1,1,1:0,91', 'directional:0,0,0:1,1,1',
                 'point:0,0,0:1,1,inf']:
        fails(2, ['--light', text], *common, '--light', text)
    assert not os.path.exists(picture)
    for text in ['point:0.3,0.3,0.3:1,1,1', 'spot:0.3,0.5,0.3:0,-1,0:1,1,1:10,30',
                 'spot:0.3,0.5,0.3:0,-1,0:1,1,1:cosine', 'directional:0,-1,-1:1,1,1']:
        succeeds(*common, '--light', text)
    succeeds(*common, '--camera', 'front')
    succeeds(*common, '--camera-at', '0.3,0.3,-1:0.3,0.3,0:40')


def pictures_that_are_broken_are_refused(folder):
    good = folder + '/good.pfm'
    with open(good, 'wb') as f:
        f.write(b'PF\n1 1\n-1.0\n' + struct.pack('<3f', 1, 2, 3))
    for name, data in [('a.png', b'no picture'), ('b.exr', b'v/1\x01'), ('c.pfm', b'PF\n4 4\n-1.0\nshort')]:
        with open(os.path.join(folder, name), 'wb') as f:
            f.write(data)
        fails(3, [name], 'compare', os.path.join(folder, name), good)
        fails(3, [name], 'compare', good, os.path.join(folder, name))
    fails(3, ['gone.png'], 'compare', folder + '/gone.png', good)
    wide = folder + '/wide.pfm'
    with open(wide, 'wb') as f:
        f.write(b'PF\n2 1\n-1.0\n' + struct.pack('<6f', 1, 2, 3, 4, 5, 6))
    fails(3, ['sizes must be equal'], 'compare', good, wide)


def outputs_that_cannot_be_written_fail_before_the_work(folder):
    fails(1, ['/nowhere/'], 'render', 'cornell', '--size', '8x8', '-o', folder + '/nowhere/a.png')
    fails(1, ['/nowhere/'], 'render', 'cornell', '--size', '8x8', '-o', folder + '/a.png', '--stats',
          folder + '/nowhere/a.json')
    fails(1, ['cannot'], 'reference', 'cornell', '--size', '8x8', '-o', '/proc/a.png')
    os.mkdir(folder + '/is.png')
    fails(1, ['is.png'], 'render', 'cornell', '--size', '8x8', '-o', folder + '/is.png')
    with open(folder + '/plain', 'w'):
        pass
    fails(1, ['plain'], 'sequence', 'cornell', '--frames', 1, '-o', folder + '/plain')
    fails(1, ['plain'], 'stability', '-o', folder + '/plain')
    fails(1, ['plain'], 'report', '-o', folder + '/plain')
    assert sorted(os.listdir(folder)) == ['is.png', 'plain']


def results_that_nobody_can_take_are_a_failure(folder):
    picture = folder + '/a.pfm'
    with open('/dev/full', 'w') as full:
        for words in [['plugins'], ['info', 'cornell'], ['graph', 'cornell', '--size', '8x8'], ['--help']]:
            assert Run(words, stdout=full).code == 1, words
    run = fails(1, ['/dev/full'], 'render', 'cornell', '--size', '8x8', '-o', picture, '--stats', '/dev/full')
    assert not os.path.exists(picture), run
    run = Run(['plugins'], preexec_fn=lambda: os.close(1))
    assert run.code == 1 and run.lines('error') == ['afterglow: error: stdout: cannot write'], run


def a_warning_never_ends_in_a_picture(folder):
    # A descriptor that the caller closed must not become the file's.
    with open(folder + '/gi_broken.so', 'w') as f:
        f.write('no module')
    pictures = [folder + '/a.pfm', folder + '/b.pfm']
    words = ['render', 'cornell', '--size', '8x8', '--gi', 'broken', '--plugin-dir', folder, '-o']
    succeeds(*words, pictures[0])
    assert Run([*words, pictures[1]], preexec_fn=lambda: os.closerange(0, 3)).code == 0
    assert open(pictures[0], 'rb').read() == open(pictures[1], 'rb').read()


def control_letters_stay_in_one_line(folder):
    fails(3, [], 'render', folder + '/two\nlines.gltf', '-o', folder + '/a.png')


if __name__ == '__main__':
    main([help_is_there_for_every_command, unknown_words_are_wrong_usage,
          bad_values_name_option_value_and_rule, plugins_and_parameters_are_checked,
          a_refused_module_leaves_direct_light, scenes_that_are_missing_or_broken_are_refused,
          cameras_and_lights_are_checked, pictures_that_are_broken_are_refused,
          every_plugin_means_those_that_load, outputs_that_cannot_be_written_fail_before_the_work,
          results_that_nobody_can_take_are_a_failure, a_warning_never_ends_in_a_picture, control_letters_stay_in_one_line])
