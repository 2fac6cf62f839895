#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Embeds a GLSL file as a C object and compiles every permutation of it.

    embed_glsl.py [-I FOLDER]... ROOT INPUT HEADER DEPFILE GLSLANG [DEFINES]...

ROOT is the source root: the shader is named by its path below it. Includes are looked
for beside the including file, below ROOT, then below each FOLDER. HEADER gets a
`static const fg_gl_shader <file>_<stage>` with the includes expanded. Each
DEFINES ("A=1;B", "" for none) is one permutation, which GLSLANG must accept;
without any the shader is compiled once, plain. GLSLANG "-" compiles nothing.
"""
import pathlib
import re
import subprocess
import sys
import tempfile


def expand(path, folders, seen):
    """The lines of `path` with `#include "file"` replaced, each file once. A path is looked for
    beside the including file, then below the folders."""
    seen.append(path)
    for number, line in enumerate(path.read_text().splitlines(), 1):
        include = re.match(r'\s*#include\s+"([^"]+)"', line)
        if not include:
            yield line
            continue
        places = [folder / include[1] for folder in [path.parent, *folders]]
        target = next((place for place in places if place.exists()), None)
        if not target:
            sys.exit(f'{path}:{number}: no file {include[1]}')
        target = target.resolve()
        if target not in seen:
            yield '#line 1'
            yield from expand(target, folders, seen)
            yield f'#line {number + 1}'


def with_defines(text, defines):
    head, _, body = text.partition('\n')
    lines = [f'#define {d.replace("=", " ", 1)}' for d in defines.split(';') if d]
    return '\n'.join([head, *lines, '#line 2', body])


def main():
    words, folders = sys.argv[1:], []
    while words[0] == '-I':
        folders.append(pathlib.Path(words[1]).resolve())
        words = words[2:]
    root, source, header, depfile, glslang, *permutations = words
    root, source = pathlib.Path(root).resolve(), pathlib.Path(source).resolve()
    if root not in source.parents:
        sys.exit(f'{source}: is not below {root}')
    seen = []
    text = '\n'.join(expand(source, [root, *folders], seen)) + '\n'
    if not text.startswith('#version 450 core\n'):
        sys.exit(f'{source}:1: the first line must be "#version 450 core"')
    for defines in [] if glslang == '-' else permutations or ['']:
        with tempfile.NamedTemporaryFile('w', suffix=source.suffix) as f:
            f.write(with_defines(text, defines))
            f.flush()
            done = subprocess.run([glslang, '--quiet', f.name], capture_output=True, text=True)
        if done.returncode:
            sys.exit(f'{source} [{defines}]:\n{done.stdout.replace(f.name, source.name)}{done.stderr}')

    symbol = re.sub(r'\W', '_', source.name)
    codes = ','.join(map(str, text.encode())) + ',0'
    pathlib.Path(header).write_text(
        f'#include <fg/gl.h>\n'
        f'static const char {symbol}_text[] = {{{codes}}};\n'
        f'static const fg_gl_shader {symbol} = {{ "{source.relative_to(root)}", {symbol}_text }};\n')
    escaped = [str(name).replace(' ', '\\ ') for name in [header, *seen]]
    pathlib.Path(depfile).write_text(f'{escaped[0]}: {" ".join(escaped[1:])}\n')


main()
