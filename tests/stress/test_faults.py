# SPDX-License-Identifier: MIT
"""The stability table finds plugins that are at fault, and says where."""
import json
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', 'cli'))
from harness import Run, fails, main  # noqa: E402

MODULES = os.environ['FAULTY_PLUGINS']


def cases(folder, plugin, *names):
    """What the table says of the plugin: case -> entry. Direct light has to pass."""
    run = Run(['stability', *names, '--gi', plugin, '--plugin-dir', MODULES, '-o', folder])
    with open(folder + '/stability.json') as f:
        entries = json.load(f)['cases']
    assert all(e['status'] == 'pass' for e in entries if e['plugin'] == 'none'), run
    own = {e['case']: e for e in entries if e['plugin'] == plugin}
    assert set(own) == set(names), run
    failed = sum(e['status'] == 'fail' for e in own.values())
    assert run.code == (1 if failed else 0), run
    if failed:
        assert '%d of %d cases failed' % (failed, len(entries)) in run.lines('error')[0], run
    return own


def a_sound_plugin_passes(folder):
    own = cases(folder, 'sound', 'slivers_and_backs', 'same_frame_twice')
    assert all(e['status'] == 'pass' for e in own.values()), own


def infinity_in_a_buffer_is_found(folder):
    entry = cases(folder, 'not_finite', 'slivers_and_backs')['slivers_and_backs']
    assert entry['status'] == 'fail' and 'not_finite.indirect' in entry['note'], entry


def negative_light_is_found(folder):
    entry = cases(folder, 'negative', 'slivers_and_backs')['slivers_and_backs']
    assert entry['status'] == 'fail' and 'negative.indirect' in entry['note'], entry


def a_texture_that_was_promised_and_not_written_is_found(folder):
    entry = cases(folder, 'unwritten', 'slivers_and_backs')['slivers_and_backs']
    assert entry['status'] == 'fail' and 'unwritten.indirect' in entry['note'], entry


def a_frame_that_changes_is_found(folder):
    entry = cases(folder, 'changing', 'same_frame_twice')['same_frame_twice']
    assert entry['status'] == 'fail' and entry['measured'] > 0, entry


def light_without_a_light_is_found(folder):
    entry = cases(folder, 'sound', 'no_light')['no_light']
    assert entry['status'] == 'fail' and entry['measured'] > 0, entry


def unknown_cases_are_wrong_usage(folder):
    fails(2, ['nonesuch'], 'stability', 'nonesuch', '-o', folder)


if __name__ == '__main__':
    main([a_sound_plugin_passes, infinity_in_a_buffer_is_found, negative_light_is_found,
          a_texture_that_was_promised_and_not_written_is_found, a_frame_that_changes_is_found,
          light_without_a_light_is_found, unknown_cases_are_wrong_usage])
