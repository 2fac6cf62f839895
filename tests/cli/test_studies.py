# SPDX-License-Identifier: MIT
"""The studies of the report: figures of the papers, measured and drawn again."""
import json
import os

from harness import fails, main, succeeds, write_triangle


def load(folder):
    with open(folder + '/report.json') as f:
        return json.load(f)


def words(names):
    return [word for name in names for word in ('--study', name)]


STUDY = ['--gi', 'rsm', '--set', 'rsm_size=16', '--set', 'vpls=16', '--size', '16x16', '--spp', 256]


def studies_are_measured_and_drawn(folder):
    names = ['stages', 'vpls', 'solid_angle']
    run = succeeds('report', 'cornell', *STUDY, *words(names), '-o', folder)
    report = load(folder)
    assert report['records'] == [] and [s['name'] for s in report['studies']] == names
    stages, count, angle = report['studies']
    for study in report['studies']:
        assert study['scene'] == 'cornell' and study['title'] and {p['plugin'] for p in study['points']} == {'rsm'}
        for point in study['points']:
            # The first stage is what the others leave of the frame's median.
            assert sum(s['ms'] for s in point['stages']) >= 0.999 * point['frame_ms']['median'] > 0
    named = {s['stage']: s['ms'] for s in stages['points'][0]['stages']}
    assert named['RSM'] > 0 and named['gather, splat'] > 0 and named['other'] == 0, named
    assert [p['x'] for p in angle['points']] == ['exact', 'equal']
    assert [p['params']['solid_angle'] for p in angle['points']] == ['exact', 'equal']
    assert all(p['params']['rsm_size'] == 16 for p in angle['points'])
    exact, equal = [p['errors'] for p in angle['points']]
    assert exact[0]['rmse'] == 0 < equal[0]['rmse_max'] < equal[0]['rmse_rms']
    assert exact[1]['reference'] == 'path1_unshadowed' and exact[1]['rmse'] > 0
    assert any('stages is without isr, splat' in line for line in run.lines('warning')), run
    assert any('stages is without isr, splat' in note for note in report['notes'])
    # Sixteen texels along an edge: 256 VPLs are all there are.
    errors = [p['errors'][0]['rmse'] for p in count['points'] if p['curve'] == 'regular']
    assert [p['x'] for p in count['points']][:3] == [16, 64, 256] and errors[0] > errors[1] > errors[2] == 0, errors
    for name in ['stages_0', 'solid_angle_0', 'solid_angle_1', 'vpls_0', 'vpls_1']:
        assert os.path.getsize('%s/plots/cornell_study_%s.svg' % (folder, name)) > 1000
    with open(folder + '/report.html') as f:
        page = f.read()
    assert stages['title'] in page and page.count('<svg') == 5


def a_path_is_walked_where_something_moves(folder):
    still = folder + '/still.gltf'
    write_triangle(still)
    run = succeeds('report', still, 'atrium', *STUDY, '--study', 'path', '-o', folder)
    report = load(folder)
    assert any('nothing moves in ' + still in line for line in run.lines('warning')), run
    assert [s['scene'] for s in report['studies']] == ['atrium']
    # No truth is traced for what is compared with none.
    assert not any(scene.get('references') for scene in report['scenes'])
    path = report['studies'][0]['points'][0]['path']
    assert len(path['ms']) == len(path['seconds']) == 12 and min(path['ms']) > 0
    assert path['seconds'] == [2 * i for i in range(12)]  # of 24 s
    assert os.path.getsize(folder + '/plots/atrium_study_path_0.svg') > 1000


def studies_of_shards_join(folder):
    common = ['report', 'cornell', *STUDY, '--study', 'stages', '--study', 'solid_angle']
    parts = ['%s/%d' % (folder, i) for i in [2, 1]]
    for i, part in enumerate(parts):
        succeeds(*common, '--shard', '%d/2' % (2 - i), '-o', part)
        assert len(load(part)['studies']) == 1
    succeeds('report', '--merge', *parts, '-o', folder + '/joined')
    joined = load(folder + '/joined')
    assert [s['name'] for s in joined['studies']] == ['stages', 'solid_angle']
    assert any('stages is without isr, splat' in note for note in joined['notes'])
    assert os.path.exists(folder + '/joined/plots/cornell_study_stages_0.svg')
    fails(3, ['another folder has'], 'report', '--merge', parts[0], parts[0], '-o', folder + '/twice')


IIR = ['report', 'cornell', '--gi', 'iir', '--set', 'map_size=16', '--size', '8x8', '--spp', 1]


def by_curve(report, name):
    study = next(s for s in report['studies'] if s['name'] == name)
    return {p['curve']: p for p in study['points']}


def incremental_and_anew_are_tables_of_all_scenes(folder):
    succeeds(*IIR, '--study', 'iir_tables', '-o', folder)
    report = load(folder)
    points = by_curve(report, 'iir_tables')
    assert report['notes'] == [] and len(points) == 4, points.keys()
    assert [p['size'] for p in points.values()] == [[8, 8], [8, 8], [13, 13], [13, 13]]
    for curve, point in points.items():
        stages = {s['stage']: s['ms'] for s in point['stages']}
        assert all(stages[name] > 0 for name in ['split', 'gather, splat', 'combine', 'filter']), stages
        assert stages['other'] == 0, [p['name'] for p in point['passes']]
        # A tour moves the light of a scene in which nothing moves; no more than recalc_max are new.
        maps = point['path']['counters']['shadow_maps']
        assert len(maps) == len(point['path']['ms']) == 8 and max(maps) > 0, maps
        assert min(maps) > 8 if 'anew' in curve else max(maps) <= 8, (curve, maps)
        assert min(point['path']['counters']['manage_ms']) > 0
    with open(folder + '/report.html') as f:
        page = f.read()
    assert 'Table 1: incremental against anew' in page and 'Table 2: common steps' in page
    assert page.count('<td>8 &times; 8</td>') == page.count('<td>13 &times; 13</td>') == 2


def counters_and_errors_are_noted_along_a_path(folder):
    run = succeeds(*IIR, *words(['iir_recalc', 'iir_path', 'iir_vpls']), '-o', folder)
    report = load(folder)
    assert report['notes'] == [] and not run.lines('warning'), run
    for curve, point in by_curve(report, 'iir_path').items():
        path = point['path']
        assert all(abs(t - 4 * i / 60) < 1e-9 for i, t in enumerate(path['seconds']))
        assert all(len(list_) == 12 for list_ in [*path['counters'].values(), *path['errors']]), path
        assert min(path['counters']['dispersion']) >= 1, (curve, path)
        errors = [e for e in path['errors'][0] if e is not None]
        assert len(errors) == 2 and path['errors'][0][-1] is not None
        assert abs(point['errors'][0]['rmse_rms'] - sum(errors) / 2) < 1e-9 and min(errors) > 0
    recalc = next(s for s in report['studies'] if s['name'] == 'iir_recalc')['points']
    assert len(recalc) == 21 and all(p['errors'][0]['nonfinite'] == 0 for p in recalc)
    # One new VPL a frame does not follow a fast light.
    fast = [p['errors'][0]['rmse_rms'] for p in recalc if p['curve'].startswith('64')]
    assert fast[0] > fast[-1], fast
    for name in ['iir_recalc_0', 'iir_recalc_1', 'iir_path_0', 'iir_path_1', 'iir_path_2', 'iir_vpls_0']:
        assert os.path.getsize('%s/plots/cornell_study_%s.svg' % (folder, name)) > 1000
    # After a tour all is where it was.
    succeeds(*IIR, '--study', 'iir_vpls', '-o', folder + '/alone')
    errors = [[p['errors'] for p in next(s for s in r['studies'] if s['name'] == 'iir_vpls')['points']]
              for r in [report, load(folder + '/alone')]]
    assert errors[0] == errors[1] and len(errors[0]) == 8


def every_setting_of_every_study_is_taken(folder):
    names = ['stages', 'eye_depth', 'eye_normal', 'initial', 'tau', 'vpls', 'solid_angle', 'visibility']
    run = succeeds('report', 'cornell', '--set', 'rsm_size=64', '--size', '4x4', '--spp', 1, *words(names), '-o', folder)
    report = load(folder)
    assert not any('does not take' in note or 'no plugin' in note for note in report['notes']), report['notes']
    assert [s['name'] for s in report['studies']] == names, run
    for study in report['studies']:
        for point in study['points']:
            other = [s['ms'] for s in point['stages'] if s['stage'] == 'other']
            assert other == [0], (study['name'], point['curve'], [p['name'] for p in point['passes']])
            assert len(point.get('errors', [])) == len(study['baselines'])
            assert all(e and e['nonfinite'] == 0 for e in point['errors']), point
    # Thresholds of zero light every pixel, as the full gather does: off by half floats at most, 2^-11.
    for study in report['studies'][1:3]:
        assert all(p['errors'][0]['rmse_rms'] < 5e-4 for p in study['points'] if p['x'] == 0), study


if __name__ == '__main__':
    main([studies_are_measured_and_drawn, a_path_is_walked_where_something_moves, studies_of_shards_join,
          incremental_and_anew_are_tables_of_all_scenes, counters_and_errors_are_noted_along_a_path,
          every_setting_of_every_study_is_taken])
