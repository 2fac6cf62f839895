# SPDX-License-Identifier: MIT
"""--trace: what the file holds of the frames, and that it is whole or not there."""
import json
import os
import statistics
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from harness import fails, main, succeeds  # noqa: E402

CPU, GPU = 'CPU', 'GPU'
FRAME = ['render', 'cornell', '--size', '32x32']


class Trace:
    """Events by track; each event is (begin, end, name, args), in ns."""

    def __init__(self, path):
        with open(path) as f:
            events = json.load(f)['traceEvents']
        names = {e['tid']: e['args']['name'] for e in events if e['name'] == 'thread_name'}
        assert sorted(names.values()) == [CPU, GPU], names
        assert [e['args']['name'] for e in events if e['name'] == 'process_name'] == ['afterglow']
        assert {e['ph'] for e in events} <= {'M', 'X', 'i', 'C'}, events
        assert {e['pid'] for e in events} == {1}
        self.tracks = {name: [] for name in names.values()}
        for e in events:
            if e['ph'] == 'X':
                begin, length = round(1000 * e['ts']), round(1000 * e['dur'])
                self.tracks[names[e['tid']]].append((begin, begin + length, e['name'], e.get('args')))
        self.marks = [(round(1000 * e['ts']), e['name']) for e in events if e['ph'] == 'i']
        self.counters = [e for e in events if e['ph'] == 'C']

    def frames(self, track):
        """[(args, begin, end, passes)] in order; a pass belongs to the frame that it lies in."""
        events = self.tracks[track]
        result = [(e[3], e[0], e[1], []) for e in events if e[3]]
        for begin, end, name, args in events:
            if args:
                continue
            around = [f for f in result if f[1] <= begin and end <= f[2]]
            assert len(around) == 1, (track, name, begin, end)
            around[0][3].append((name, begin, end))
        return sorted(result, key=lambda f: f[1])


def tracks_are_named_and_events_nest(folder):
    path = folder + '/trace.json'
    succeeds(*FRAME, '--gi', 'isr', '--frame', 3, '--trace', path, '-o', folder + '/a.png')
    trace = Trace(path)
    for track in [CPU, GPU]:
        frames = trace.frames(track)
        assert [f[0] for f in frames] == [{'frame': i, 'shows': 'isr'} for i in range(4)], frames
        for before, after in zip(frames, frames[1:]):
            assert before[2] <= after[1], (track, before[:3], after[:3])
        for _, _, _, passes in frames:
            assert passes[0][0] == 'gbuffer.draw' and 'isr.gather' in [p[0] for p in passes], passes
            for before, after in zip(passes, passes[1:]):
                assert 0 <= before[1] <= before[2] <= after[1] <= after[2], (track, before, after)
    # The same passes on both; what the GPU does of a frame does not begin before the CPU asks for it.
    # A clock that was set once is right to far less than a millisecond within seconds.
    for cpu, gpu in zip(trace.frames(CPU), trace.frames(GPU)):
        assert [p[0] for p in cpu[3]] == [p[0] for p in gpu[3]]
        assert gpu[1] >= cpu[1] - 1000000, (cpu[:3], gpu[:3])


def figures_are_those_of_stats(folder):
    path, stats = folder + '/trace.json', folder + '/stats.json'
    succeeds(*FRAME, '--gi', 'rsm', '--trace', path, '--stats', stats, '--timing-frames', 7, '-o', folder + '/a.png')
    with open(stats) as f:
        stats = json.load(f)
    trace = Trace(path)
    assert len(trace.frames(CPU)) == 9  # the picture's, one to warm up, those that are timed
    for track, key in [(GPU, 'gpu_ms'), (CPU, 'cpu_ms')]:
        timed = trace.frames(track)[-7:]
        for entry in stats['passes']:
            lengths = [end - begin for f in timed for name, begin, end in f[3] if name == entry['name']]
            assert len(lengths) == 7, entry
            # A median of whole nanoseconds that JSON holds to more than 15 digits.
            assert abs(statistics.median(lengths) * 1e-6 - entry[key]) < 1e-6, (entry, lengths)
    # fg_graph_run() is a part of the frame.
    spans = statistics.median(end - begin for _, begin, end, _ in trace.frames(CPU)[-7:])
    assert spans * 1e-6 <= stats['cpu_ms']['median'], (spans, stats['cpu_ms'])
    memory = [e['args'] for e in trace.counters if e['name'] == 'memory (bytes)']
    assert memory[-1] == {'transient': stats['memory']['transient_bytes'],
                          'persistent': stats['memory']['persistent_bytes']}, memory[-1]


def switches_are_marked(folder):
    path = folder + '/trace.json'
    succeeds('sequence', 'cornell', '--size', '16x16', '--gi', 'rsm', '--gi', 'none', '--frames', 4,
             '--trace', path, '-o', folder + '/frames')
    trace = Trace(path)
    shown = [(args['frame'], args['shows']) for args, _, _, _ in trace.frames(CPU)]
    assert [s for _, s in shown] == ['rsm', 'none', 'rsm', 'none'], shown
    assert [f[0] for f in trace.frames(GPU)] == [f[0] for f in trace.frames(CPU)]
    assert [m[1] for m in trace.marks] == ['rsm', 'rsm > none', 'none > rsm', 'rsm > none'], trace.marks
    assert [m[0] for m in trace.marks] == [f[1] for f in trace.frames(CPU)], trace.marks


def it_is_whole_or_not_there(folder):
    picture, path = folder + '/a.png', folder + '/trace.json'
    fails(1, ['nowhere'], *FRAME, '--trace', folder + '/nowhere/t.json', '-o', picture)
    fails(2, ['--trace', 'where the picture goes'], *FRAME, '--trace', picture, '-o', picture)
    fails(2, ['--trace', 'where --stats goes'], *FRAME, '--trace', path, '--stats', path, '-o', picture)
    fails(1, ['/dev/full'], *FRAME, '--trace', '/dev/full', '-o', picture)
    fails(2, ['--trace', 'unknown option'], 'graph', 'cornell', '--trace', path)
    fails(3, ['nosuchscene'], 'render', 'nosuchscene', '--trace', path, '-o', picture)
    assert os.listdir(folder) == [], os.listdir(folder)


if __name__ == '__main__':
    main([tracks_are_named_and_events_nest, figures_are_those_of_stats, switches_are_marked,
          it_is_whole_or_not_there])
