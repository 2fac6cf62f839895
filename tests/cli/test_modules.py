# SPDX-License-Identifier: MIT
"""Plugin modules from outside: where they are looked for, and how those at fault are refused."""
import json
import os
import shutil
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from harness import Run, fails, main, succeeds  # noqa: E402

BROKEN, HOT = os.environ['BROKEN_MODULES'], os.environ['HOT_MODULES']
FRAME = ['render', 'cornell', '--size', '16x16', '--layer', 'radiance']


def install(module, folder, name='hot', size=None):
    """Puts (the first bytes of) a module into the folder as gi_NAME.so."""
    os.makedirs(folder, exist_ok=True)
    with open(module, 'rb') as f:
        data = f.read(size)
    with open('%s/gi_%s.so' % (folder, name), 'wb') as f:
        f.write(data)


def direct(folder):
    path = folder + '/direct.pfm'
    succeeds(*FRAME, '-o', path)
    with open(path, 'rb') as f:
        return f.read()


def direct_light_goes_on(folder, name, why):
    """Done, the reason in one line and what follows from it in another, the picture direct light."""
    path, expected = folder + '/picture.pfm', direct(folder)
    run = succeeds(*FRAME, '--gi', name, '--plugin-dir', folder, '-o', path)
    warnings = run.lines('warning')
    assert len([line for line in warnings if why in line and name in line]) == 1, (why, str(run))
    assert len([line for line in warnings if name in line and 'direct light alone' in line]) == 1, run
    assert len(warnings) <= 2, run
    with open(path, 'rb') as f:
        assert f.read() == expected, run


def a_module_of_another_abi_is_refused(folder):
    install(BROKEN + '/gi_wrong_abi.so', folder, 'wrong_abi')
    direct_light_goes_on(folder, 'wrong_abi', 'was built for ABI 3, this host has ABI 2')


def a_module_without_its_symbol_is_refused(folder):
    install(BROKEN + '/gi_no_symbol.so', folder, 'no_symbol')
    direct_light_goes_on(folder, 'no_symbol', 'has no symbol gi_plugin_entry')


def a_module_that_fails_in_create_is_refused(folder):
    install(BROKEN + '/gi_sound.so', folder, 'sound')
    direct_light_goes_on(folder, 'sound', 'failed to start')


def a_table_with_a_broken_parameter_is_refused(folder):
    install(BROKEN + '/gi_bad_default.so', folder, 'bad_default')
    direct_light_goes_on(folder, 'bad_default', "parameter 'size' has a default outside its range")


def what_is_no_module_is_refused(folder):
    with open(folder + '/gi_text.so', 'w') as f:
        f.write('int main;\n' * 1000)
    direct_light_goes_on(folder, 'text', 'is no shared object')
    shutil.copy('/dev/null', folder + '/gi_text.so')
    direct_light_goes_on(folder, 'text', 'is no shared object')


def a_module_that_is_cut_short_is_refused(folder):
    whole = os.path.getsize(HOT + '/gi_hot1.so')
    for size in [64, 1000, 4096, 10000, whole // 2, whole - 1]:
        install(HOT + '/gi_hot1.so', folder, 'hot', size)
        direct_light_goes_on(folder, 'hot', 'is cut short')


def a_module_that_lacks_a_dependency_is_refused(folder):
    install(HOT + '/gi_unresolved.so', folder)
    direct_light_goes_on(folder, 'hot', 'nobody_defines_this')


def summary(name, env=None, folders=()):
    words = [word for folder in folders for word in ('--plugin-dir', folder)]
    listed = json.loads(succeeds('plugins', '--json', *words, env=env).out)
    return [p['summary'] for p in listed if p['name'] == name]


def the_first_folder_wins(folder):
    one, two = folder + '/one', folder + '/two'
    install(HOT + '/gi_hot1.so', one)
    install(HOT + '/gi_hot2.so', two)
    assert summary('hot') == []
    assert summary('hot', folders=[one, two]) == ['version 1']
    assert summary('hot', folders=[two, one]) == ['version 2']
    # What an option names comes before the environment, in which the first comes first.
    env = {'AFTERGLOW_PLUGIN_PATH': one + ':' + two}
    assert summary('hot', env=env) == ['version 1']
    assert summary('hot', env=env, folders=[two]) == ['version 2']
    assert summary('hot', env={'AFTERGLOW_PLUGIN_PATH': '/nonexistent:' + two}) == ['version 2']


def both_come_before_what_is_installed(folder):
    # Which file was taken is told by its being refused: it is hot by another name.
    install(HOT + '/gi_hot1.so', folder, 'rsm')
    for env, words in [({}, ['--plugin-dir', folder]), ({'AFTERGLOW_PLUGIN_PATH': folder}, [])]:
        run = succeeds(*FRAME, '--gi', 'rsm', *words, '-o', folder + '/a.pfm', env=env)
        assert any("calls itself 'hot'" in line for line in run.lines('warning')), run


def folders_are_checked(folder):
    fails(3, ['--plugin-dir', 'no folder'], 'plugins', '--plugin-dir', folder, '--plugin-dir', folder + '/none')
    words = [word for _ in range(17) for word in ('--plugin-dir', folder)]
    fails(2, ['--plugin-dir', 'at most 16 times'], 'plugins', *words)
    assert Run(['plugins', *words[:32]]).code == 0


if __name__ == '__main__':
    main([a_module_of_another_abi_is_refused, a_module_without_its_symbol_is_refused,
          a_module_that_fails_in_create_is_refused, a_table_with_a_broken_parameter_is_refused,
          what_is_no_module_is_refused, a_module_that_is_cut_short_is_refused,
          a_module_that_lacks_a_dependency_is_refused, the_first_folder_wins,
          both_come_before_what_is_installed, folders_are_checked])
