#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Makes a shell script of a document: files are written, commands run, in its order.

    document.py DOCUMENT SCRIPT

A block ```LANGUAGE FILE is that file, in the folder where the commands have gone by then; ```sh is commands;
any other block is for people alone.
"""
import pathlib
import re
import sys


def main():
    document, script = map(pathlib.Path, sys.argv[1:])
    lines = ['set -eux']
    files = commands = 0
    for info, body in re.findall(r'^```([^\n]*)\n(.*?)^```$', document.read_text(), re.M | re.S):
        words = info.split()
        if len(words) == 2:
            lines += [f"cat > {words[1]} <<'END_OF_FILE'", body + 'END_OF_FILE']
            files += 1
        elif words == ['sh']:
            lines.append(body)
            commands += 1
    if not files or not commands:
        sys.exit(f'{document}: has {files} files and {commands} blocks of commands')
    script.write_text('\n'.join(lines))


main()
