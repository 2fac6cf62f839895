# SPDX-License-Identifier: MIT
"""The viewer under Xvfb, driven by keys and mouse as a user has them."""
import json
import os
import shutil
import struct
import time
import zlib

from harness import fails, main, succeeds
from window import Screen, Viewer

FAULTY, LAYERED = os.environ['FAULTY_PLUGINS'], os.environ['LAYERED_PLUGIN']
BAD = (255, 106, 92)   # letters of a fault: ui_widgets_bridge.cpp
GRAB = (163, 106, 36)  # what a slider is held by: ui_bridge.cpp
PANEL = 390            # width of the panel at a scale of 1, pixels


def read_png(path):
    """Rows of bytes, three a pixel."""
    with open(path, 'rb') as f:
        data = f.read()
    assert data[:8] == b'\x89PNG\r\n\x1a\n'
    at, packed, size = 8, b'', None
    while at < len(data):
        length, kind = struct.unpack('>I4s', data[at:at + 8])
        if kind == b'IHDR':
            size = struct.unpack('>II', data[at + 8:at + 16])
            assert data[at + 16:at + 18] == b'\x08\x02'
        elif kind == b'IDAT':
            packed += data[at + 8:at + 8 + length]
        at += length + 12
    raw, stride = zlib.decompress(packed), 3 * size[0]
    rows, above = [], bytes(stride)
    for y in range(size[1]):
        line = raw[y * (stride + 1):(y + 1) * (stride + 1)]
        above = unfilter(line[0], bytearray(line[1:]), above)
        rows.append(bytes(above))
    return rows


def unfilter(kind, row, above):
    if kind == 2:
        return bytearray((a + b) & 255 for a, b in zip(row, above))
    for i in range(len(row) if kind else 0):
        left, up = row[i - 3] if i > 2 else 0, above[i]
        corner = above[i - 3] if i > 2 else 0
        if kind == 1:
            guess = left
        elif kind == 3:
            guess = (left + up) >> 1
        else:
            p = left + up - corner
            guess = min((abs(p - left), 0, left), (abs(p - up), 1, up), (abs(p - corner), 2, corner))[2]
        row[i] = (row[i] + guess) & 255
    return row


def crop(rows, x0, y0, x1, y1):
    return [row[3 * x0:3 * x1] for row in rows[y0:y1]]


def brightness(rows):
    return sum(map(sum, rows)) / sum(map(len, rows))


def legible(rows):
    """Letters: light pixels on a dark ground, some but not many, in most lines of text."""
    light = [sum(1 for v in row[::3] if v > 180) for row in rows]
    return sum(light) > 500 and sum(1 for n in light if n) > len(rows) / 3 and brightness(rows) < 100


def shot_of(viewer, width, height):
    rows = read_png(viewer.shot())
    assert (len(rows[0]) // 3, len(rows)) == (width, height)
    assert legible(crop(rows, 10, 10, PANEL, height - 10))
    assert brightness(crop(rows, PANEL + 10, 0, width, height - 60)) > 5
    return rows


def find_grab(rows, top):
    """The middle of the first slider's grab below `top`."""
    wanted = bytes(GRAB)
    for y in range(top, len(rows)):
        xs = [x for x in range(len(rows[y]) // 3) if rows[y][3 * x:3 * x + 3] == wanted]
        if len(xs) > 5:
            return (xs[0] + xs[-1]) // 2, y + 5
    raise AssertionError('there is no slider')


def without_a_display_it_says_so(folder):
    fails(1, ['display'], 'view', 'cornell', env={'DISPLAY': '', 'WAYLAND_DISPLAY': ''})
    fails(1, ['display', ':7654'], 'view', 'cornell', env={'DISPLAY': ':7654', 'WAYLAND_DISPLAY': ''})
    fails(3, ['nowhere'], 'view', 'nowhere', env={'DISPLAY': ''})
    fails(2, ['--render-scale'], 'view', 'cornell', '--render-scale', 3)
    fails(2, ['no plugin'], 'view', 'cornell', '--gi', 'nothing')
    text = succeeds('view', '--help').out
    assert 'Ctrl+Q' in text and 'side by side' in text and '--params' in text


def broken_sets_are_refused(folder):
    path = folder + '/set.json'
    head = '{"afterglow": "view", '
    cases = [('', ['JSON']), ('{', ['JSON']), ('[]', ['JSON']), ('{}', ['no parameter set']),
             (head + '"exposure": 0}', ['exposure', '1e-09']),
             (head + '"shutter": 1}', ['shutter']),
             (head + '"plugin": "nothing"}', ['nothing']),
             (head + '"plugin": "rsm", "params": {"rsm_size": 100}}', ['rsm_size', '100']),
             (head + '"plugin": "rsm", "params": {"speed": 1}}', ['speed']),
             (head + '"plugin": "rsm", "layer": "hisr.level"}', ['hisr.level']),
             (head + '"camera": {"name": "moon"}}', ['moon']),
             (head + '"camera": {"eye": [0, 1]}}', ['eye'])]
    with Screen() as screen:
        for text, words in cases:
            with open(path, 'w') as f:
                f.write(text)
            fails(3, words, 'view', 'cornell', '--size', '64x48', '--params', path, env=screen.env)
    fails(3, ['absent.json'], 'view', 'cornell', '--params', folder + '/absent.json', env={'DISPLAY': ''})


def a_picture_is_that_of_render(folder):
    size, truth = '96x64', folder + '/render.png'
    with Screen() as screen:
        for layer in ['final', 'normal', 'position', 'indirect']:
            args = ['cornell', '--gi', 'rsm', '--size', size, '--layer', layer]
            with Viewer(screen, folder, *args, '--render-scale', 1, '--exposure', 2) as viewer:
                viewer.wait('first frame with rsm')
                viewer.do('key', 'space')
                viewer.key('r', 'plugin rsm')
                viewer.do('key', 'Tab')
                time.sleep(0.5)
                frame, window = viewer.shot('F5'), viewer.shot()
                viewer.quits()
            succeeds('render', *args, '--exposure', 2, '-o', truth)
            want, frame, window = read_png(truth), read_png(frame), read_png(window)
            # The frame's goes through the same code. The window's is encoded by the GPU, whose pow() may
            # end on the other side of a half: one step of 255.
            assert want == frame, layer
            worst = max(abs(a - b) for p, q in zip(want, window) for a, b in zip(p, q))
            assert worst <= 1, (layer, worst)


def looks_around(viewer):
    """Drags with the right button. One press among very many was seen to be lost on its way: then again."""
    for last in [False, False, True]:
        viewer.do('mousemove', 500, 300, 'mousedown', 3)
        time.sleep(0.2)
        viewer.do('mousemove', 520, 330, 'mouseup', 3)
        try:
            return viewer.wait('camera free', 60 if last else 10)
        except AssertionError:
            if last:
                raise


def it_is_driven_by_keys_and_mouse(folder):
    plugins = sorted(p['name'] for p in json.loads(succeeds('plugins', '--json').out))
    with Screen() as screen, Viewer(screen, folder, 'cornell', '--size', '600x560', '--render-scale', 4) as viewer:
        viewer.wait(r'first frame after \d+ ms')
        viewer.wait(r'first frame with hisr after \d+ ms')
        viewer.do('key', 'space')
        viewer.key('r', 'plugin hisr')
        time.sleep(0.3)
        first = shot_of(viewer, 600, 560)

        # Through all of them and back: each starts, and the panel is what it was.
        order = plugins + ['none']
        start = order.index('hisr')
        for name in order[start + 1:] + order[:start + 1]:
            viewer.key('n', 'plugin ' + name + '\n')
        time.sleep(0.3)
        again = shot_of(viewer, 600, 560)
        for top, bottom in [(30, 205), (360, 550)]:  # but for times, which stand between
            assert crop(first, 10, top, 350, bottom) == crop(again, 10, top, 350, bottom)

        # A slider is moved: one value changes, and nothing else.
        before = viewer.saved()
        x, y = find_grab(crop(again, 0, 0, 350, 560), 350)
        viewer.do('mousemove', x, y, 'mousedown', 1)
        time.sleep(0.2)
        viewer.do('mousemove', x - 60, y)
        time.sleep(0.2)
        viewer.do('mouseup', 1)
        viewer.wait('plugin hisr\n')
        viewer.do('mousemove', 500, 300)
        after = viewer.saved()
        changed = [k for k in before['params'] if before['params'][k] != after['params'][k]]
        assert changed == ['rsm_size'] and after['params']['rsm_size'] in [2 ** k for k in range(11)], changed
        assert {**after, 'params': None} == {**before, 'params': None}

        # Split, layers, exposure, mouse: then the set is loaded again.
        viewer.key('x', 'split ')
        split = shot_of(viewer, 600, 560)
        divider = viewer.saved()['divider']
        assert PANEL / 600 < divider < 1 # beside the panel, not below it
        viewer.do('mousemove', int(divider * 600), 100, 'mousedown', 1)
        time.sleep(0.2)
        viewer.do('mousemove', 450, 100, 'mouseup', 1)
        viewer.key('shift+n', 'split hisr\n')
        viewer.key('shift+n', 'split iir\n')
        viewer.key('l', 'layer radiance\n')
        viewer.key('k', 'layer final\n')
        viewer.do('key', 'equal')
        looks_around(viewer)
        moved = shot_of(viewer, 600, 560)
        assert crop(moved, 400, 0, 600, 500) != crop(split, 400, 0, 600, 500)
        other = viewer.saved()
        assert abs(other['divider'] - 450 / 600) < 0.01, other['divider'] # where the mouse let it go
        assert other['second']['plugin'] == 'iir' and other['exposure'] > 1.2 and 'eye' in other['camera']
        with open(folder + '/view.json', 'w') as f:
            json.dump(after, f)
        viewer.key('F8', 'loaded ')
        viewer.wait('split off')
        assert viewer.saved() == after
        with open(folder + '/view.json', 'w') as f:
            f.write('{"afterglow": "view", "plugin": ')
        viewer.key('F8', 'warning: .*view.json')

        # Another size.
        viewer.do('search', '--name', 'afterglow', 'windowsize', 640, 500)
        viewer.wait('size 160 x 125')
        time.sleep(0.3)
        shot_of(viewer, 640, 500)
        frame = read_png(viewer.shot('F5'))
        assert (len(frame[0]) // 3, len(frame)) == (160, 125) and brightness(frame) > 5
        viewer.quits()


def modules_come_and_go(folder):
    modules = folder + '/modules'
    os.mkdir(modules)

    def install(module):
        shutil.copy(module, modules + '/new')
        os.rename(modules + '/new', modules + '/gi_layered.so')

    args = ['cornell', '--size', '600x400', '--render-scale', 4, '--plugin-dir', modules, '--gi', 'none']
    with Screen() as screen, Viewer(screen, folder, *args) as viewer:
        viewer.wait('first frame after')
        viewer.do('key', 'space')
        viewer.key('r', 'plugin none\n')
        plain = viewer.shot('F5')
        # One that appears while the window is open is in the list: the last but those built in.
        install(LAYERED)
        time.sleep(3)
        viewer.key('p', 'plugin layered\n')
        viewer.key('k', 'layer layered.odd')
        viewer.key('k', 'warning: .*layered.absent') # at these settings: it is not insisted on
        viewer.wait('layer final')
        # Another file in its place, then something that is no module.
        install(LAYERED)
        viewer.wait('layered: loaded again')
        viewer.wait('plugin layered\n')
        with open(modules + '/gi_layered.so', 'w') as f:
            f.write('no module')
        viewer.wait('goes on as it was')
        viewer.key('n', 'plugin none\n')
        assert read_png(viewer.shot('F5')) == read_png(plain)
        viewer.quits()


def a_key_that_is_held_ends_with_the_focus(folder):
    with Screen() as screen, Viewer(screen, folder, 'cornell', '--size', '64x48', '--gi', 'none') as viewer:
        viewer.wait('first frame after')
        viewer.do('keydown', 'w')
        viewer.wait('camera free')
        viewer.do('search', '--name', 'afterglow', 'windowunmap')
        time.sleep(0.5)
        viewer.do('keyup', 'w') # which nobody hears
        viewer.do('search', '--name', 'afterglow', 'windowmap', '--sync', 'windowfocus')
        time.sleep(0.5)
        eye = viewer.saved()['camera']['eye']
        time.sleep(0.5)
        assert viewer.saved()['camera']['eye'] == eye
        viewer.quits()


def a_fault_is_red_in_the_panel(folder):
    args = ['cornell', '--size', '600x400', '--render-scale', 4, '--plugin-dir', FAULTY, '--gi', 'failing', '--gi', 'rsm']
    with Screen() as screen, Viewer(screen, folder, *args) as viewer:
        viewer.wait("warning: plugin 'failing' failed in its frame")
        viewer.wait('first frame with failing')
        faulty = crop(shot_of(viewer, 600, 400), 0, 20, PANEL, 80)
        viewer.key('n', 'plugin rsm\n')
        time.sleep(0.3)
        sound = crop(shot_of(viewer, 600, 400), 0, 20, PANEL, 80)
        red = [sum(row[3 * x:3 * x + 3] == bytes(BAD) for row in rows for x in range(PANEL)) for rows in (faulty, sound)]
        assert red[0] > 100 and red[1] == 0, red
        viewer.quits()


def frames_are_traced(folder):
    path = folder + '/trace.json'
    args = ['cornell', '--gi', 'rsm', '--size', '64x48', '--frames', 20, '--trace', path]
    with Screen() as screen:
        succeeds('view', *args, env=screen.env)
        with open(path) as f:
            events = json.load(f)['traceEvents']
        for track in [1, 2]:  # the panel and the split's copies are no passes of the graph
            frames = [e['args']['shows'] for e in events
                      if e['ph'] == 'X' and e['tid'] == track and e['name'].startswith('frame ')]
            assert frames.count('rsm') >= 10 and set(frames) <= {'none', 'rsm'}, frames
        os.unlink(path)
        fails(1, ['nowhere'], 'view', 'cornell', '--trace', folder + '/nowhere/t.json', env=screen.env)
    assert os.listdir(folder) == [], os.listdir(folder)


if __name__ == '__main__':
    main([without_a_display_it_says_so, broken_sets_are_refused, a_picture_is_that_of_render,
          it_is_driven_by_keys_and_mouse, a_key_that_is_held_ends_with_the_focus, modules_come_and_go,
          a_fault_is_red_in_the_panel, frames_are_traced])
