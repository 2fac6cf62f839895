#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Turns a text file into a C array of its name: embed_text.py report.css report_css.h"""
import os
import re
import sys

source, target = sys.argv[1:3]
name = re.sub(r'\W', '_', os.path.basename(source))
with open(source, 'rb') as f:
    data = f.read() + b'\0'
rows = [', '.join(str(b) for b in data[i:i + 20]) for i in range(0, len(data), 20)]
with open(target, 'w') as f:
    f.write('static const unsigned char %s[] = {\n    %s,\n};\n' % (name, ',\n    '.join(rows)))
