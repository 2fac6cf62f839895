# SPDX-License-Identifier: MIT
"""The report: records, shards that join to the whole, a page that a browser opens without a complaint."""
import csv
import html.parser
import json
import os
import shutil
import subprocess

from harness import fails, main, succeeds, write_triangle

SMALL = ['--size', '32x32', '--spp', '8']


def load(folder):
    with open(folder + '/report.json') as f:
        return json.load(f)


def keys(report):
    return [(r['scene'], r['plugin'], json.dumps(r['params'], sort_keys=True)) for r in report['records']]


def records_have_the_shape_that_is_promised(folder):
    succeeds('report', 'cornell', *SMALL, '-o', folder)
    report = load(folder)
    assert {r['plugin'] for r in report['records']} >= {'none', 'rsm'}
    assert len(set(keys(report))) == len(report['records']) >= 4
    assert [t['name'] for t in report['scenes'][0]['references']] == ['path1', 'path1_unshadowed']
    for r in report['records']:
        assert r['scene'] == 'cornell' and r['size'] == [32, 32]
        assert 0 < r['frame_ms']['min'] <= r['frame_ms']['median'] <= r['frame_ms']['p99']
        assert r['passes'] and 'transient_bytes' in r['memory'] and isinstance(r['left_out'], list)
        assert r['error']['reference'] == 'path1'
        assert [e['reference'] for e in r['errors']] == ['path1', 'path1_unshadowed']
        for name in ['rmse', 'rmse_rms', 'rmse_max', 'relmse', 'smape', 'bias', 'energy_ratio', 'p99', 'nonfinite']:
            assert isinstance(r['error'][name], (int, float)), name
        if r['plugin'] == 'none':
            assert abs(r['error']['rmse_rms'] - 1) < 1e-6 and r['error']['energy_ratio'] == 0
            assert all(abs(e['rmse_rms_corrected'] - 1) < 1e-6 for e in r['errors'])
        for name in [r['images']['result'], *r['images']['error']]:
            assert os.path.getsize(os.path.join(folder, name)) > 0
    with open(folder + '/report.csv', newline='') as f:
        rows = list(csv.DictReader(f))
    assert len(rows) == len(report['records'])
    for row, r in zip(rows, report['records']):
        assert row['plugin'] == r['plugin']
        assert abs(float(row['path1_rmse']) - r['error']['rmse']) <= 1e-6 * r['error']['rmse']


def shards_join_to_the_whole(folder):
    common = ['report', 'cornell', '--gi', 'rsm', *SMALL]
    succeeds(*common, '-o', folder + '/whole')
    for i in [1, 2, 3]:
        succeeds(*common, '--shard', '%d/3' % i, '-o', '%s/part%d' % (folder, i))
    parts = [folder + '/part%d' % i for i in [3, 1, 2]]
    succeeds('report', '--merge', *parts, '-o', folder + '/joined')
    whole, joined = load(folder + '/whole'), load(folder + '/joined')
    assert keys(joined) == keys(whole)
    for a, b in zip(whole['records'], joined['records']):
        assert a['error'] == b['error'], a['label']
        assert os.path.exists(os.path.join(folder, 'joined', b['images']['result']))
    assert os.path.getsize(folder + '/joined/report.html') > 10000
    fails(3, ['another folder has'], 'report', '--merge', parts[0], parts[0], '-o', folder + '/twice')


def noise_of_the_truth_is_taken_out(folder):
    # The same pictures against truths of 16 and of 1024 samples: what is corrected stays, what is
    # not falls by more than the correction moves.
    errors = []
    for spp in [16, 1024]:
        out = '%s/%d' % (folder, spp)
        succeeds('report', 'cornell', '--gi', 'rsm', '--set', 'vpls=1024', '--size', '32x32', '--spp', spp, '-o', out)
        errors.append([r['errors'][1] for r in load(out)['records'] if r['plugin'] == 'rsm'][0])
    few, many = errors
    assert few['rmse_rms'] > 1.5 * many['rmse_rms'], errors
    assert abs(few['rmse_rms_corrected'] - many['rmse_rms_corrected']) < 0.5 * (few['rmse_rms'] - many['rmse_rms']), errors


def a_set_parameter_is_not_swept(folder):
    succeeds('report', 'cornell', '--gi', 'rsm', '--set', 'vpls=16', *SMALL, '-o', folder)
    values = {r['params']['vpls'] for r in load(folder)['records'] if r['plugin'] == 'rsm'}
    assert values == {16}


def broken_reports_are_refused(folder):
    os.mkdir(folder + '/a')
    fails(3, ['report.json'], 'report', '--merge', folder + '/a', '-o', folder + '/out')
    base = {'notes': [], 'device': {}, 'scenes': [], 'size': [1, 1], 'budget': 'quick'}
    for text in ['', '{', '[]', '{"records": 3}',
                 json.dumps({**base, 'records': [{'images': {'result': '../../etc/passwd'}}]}),
                 json.dumps({**base, 'records': [{'images': {'result': '/etc/passwd'}}]})]:
        with open(folder + '/a/report.json', 'w') as f:
            f.write(text)
        fails(3, ['report.json'], 'report', '--merge', folder + '/a', '-o', folder + '/out')
    assert not os.path.exists(folder + '/out/report.json')


def a_missing_shard_is_said(folder):
    common = ['report', 'cornell', '--gi', 'none', '--size', '8x8', '--spp', 1]
    succeeds(*common, '--shard', '1/2', '-o', folder + '/part')
    run = succeeds('report', '--merge', folder + '/part', '-o', folder + '/joined')
    assert any('1 of 2 shards' in line for line in run.lines('warning')), run
    assert any('1 of 2 shards' in note for note in load(folder + '/joined')['notes'])


def scenes_of_one_name_keep_their_pictures(folder):
    # One triangle alone receives no indirect light: there is no relative error to plot, either.
    for place in ['a', 'b']:
        os.mkdir(os.path.join(folder, place))
        write_triangle(os.path.join(folder, place, 'scene.gltf'))
    scenes = [os.path.join(folder, place, 'scene.gltf') for place in ['a', 'b']]
    out = os.path.join(folder, 'the "report" it\'s')
    run = succeeds('report', *scenes, '--gi', 'none', '--size', '8x8', '--spp', 1, '-o', out)
    assert not any('gnuplot' in line for line in run.lines('warning')), run
    assert any('no relative error' in line for line in run.lines('warning')), run
    names = [t['image'] for s in load(out)['scenes'] for t in s['references']]
    names += [r['images']['result'] for r in load(out)['records']]
    assert len(set(names)) == 6, names
    assert len([name for name in os.listdir(out + '/plots') if name.endswith('_passes.svg')]) == 2
    fails(2, ['twice'], 'report', 'cornell', 'cornell', '-o', out)


def missing_plotters_are_said_and_no_failure(folder):
    run = succeeds('report', 'cornell', '--gi', 'none', *SMALL, '-o', folder, env={'PATH': folder})
    assert any('gnuplot is not installed' in line for line in run.lines('warning')), run
    assert any('dot is not installed' in line for line in run.lines('warning')), run
    with open(folder + '/report.html') as f:
        assert 'gnuplot is not installed' in f.read()


class Page(html.parser.HTMLParser):
    def __init__(self):
        super().__init__()
        self.images, self.svgs, self.ranges, self.ids, self.outside = [], 0, 0, [], []

    def handle_starttag(self, tag, attrs):
        attrs = dict(attrs)
        self.svgs += tag == 'svg'
        self.ranges += attrs.get('type') == 'range'
        if tag == 'img':
            self.images.append(attrs.get('src', ''))
        if attrs.get('id'):
            self.ids.append(attrs['id'])
        for name in ['src', 'href', 'xlink:href']:
            value = attrs.get(name, '')
            if value and not value.startswith(('data:', '#')):
                self.outside.append(value)


def the_page_opens_in_a_browser(folder):
    for tool in ['gnuplot', 'dot']:
        assert shutil.which(tool), tool + ' is needed for this test'
    browser = shutil.which('chromium') or shutil.which('chromium-browser') or shutil.which('google-chrome')
    assert browser, 'chromium is needed for this test'
    succeeds('report', 'cornell', '--gi', 'rsm', *SMALL, '-o', folder)
    done = subprocess.run([browser, '--headless', '--no-sandbox', '--disable-gpu', '--enable-logging=stderr',
                           '--user-data-dir=' + folder + '/profile', '--virtual-time-budget=2000', '--dump-dom',
                           'file://' + folder + '/report.html'],
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=200)
    console = [line for line in done.stderr.decode(errors='replace').splitlines() if 'CONSOLE' in line]
    assert done.returncode == 0 and not console, console
    page = Page()
    page.feed(done.stdout.decode())
    records = len(load(folder)['records'])
    assert page.svgs >= 3 + 2, page.svgs  # two fronts, bars, two graphs
    assert page.ranges == records and len(page.images) == 3 * records
    assert all(src.startswith('data:image/png;base64,') and len(src) > 100 for src in page.images)
    assert len(page.ids) == len(set(page.ids))
    assert not page.outside, page.outside


if __name__ == '__main__':
    main([records_have_the_shape_that_is_promised, shards_join_to_the_whole, noise_of_the_truth_is_taken_out,
          a_set_parameter_is_not_swept, a_missing_shard_is_said, scenes_of_one_name_keep_their_pictures,
          broken_reports_are_refused, missing_plotters_are_said_and_no_failure, the_page_opens_in_a_browser])
