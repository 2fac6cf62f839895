#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What framegraph/embed_glsl.py makes and refuses.

    test_embed_glsl.py EMBED_GLSL GLSLANG
"""
import pathlib
import subprocess
import sys
import tempfile
import unittest

VERSION = '#version 450 core\n'
COMPUTE = VERSION + 'layout(local_size_x = 1) in;\n'


class Embed(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix='embed glsl ')  # a blank: paths are quoted
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name).resolve()
        (self.root / 'on').mkdir()

    def write(self, name, text):
        (self.root / name).write_text(text)

    def embed(self, name, *defines, glslang=None, folders=()):
        options = [word for folder in folders for word in ('-I', folder)]
        done = subprocess.run(
            [sys.executable, EMBED_GLSL, *options, self.root, self.root / name, self.root / 'out.h',
             self.root / 'out.d', glslang or GLSLANG, *defines], capture_output=True, text=True)
        return done.returncode, done.stderr

    def text(self):
        """The shader that out.h holds."""
        codes = (self.root / 'out.h').read_text().split('{', 1)[1].split('}', 1)[0]
        return bytes(map(int, codes.split(','))).rstrip(b'\0').decode()

    def test_header_names_the_shader_by_its_path(self):
        self.write('on/a.comp', COMPUTE + 'void main() {}\n')
        self.assertEqual(self.embed('on/a.comp'), (0, ''))
        header = (self.root / 'out.h').read_text()
        self.assertIn('static const fg_gl_shader a_comp = { "on/a.comp", a_comp_text };', header)
        self.assertEqual(self.text(), COMPUTE + 'void main() {}\n')

    def test_includes_are_found_beside_then_below_the_root_and_once(self):
        self.write('both.glsl', 'wrong\n')
        self.write('on/both.glsl', 'int both;\n')
        self.write('root.glsl', '#include "on/both.glsl"\nint root;\n')
        self.write('on/a.comp', VERSION + '#include "both.glsl"\n#include "root.glsl"\n'
                   'layout(local_size_x = 1) in;\nvoid main() {}\n')
        self.assertEqual(self.embed('on/a.comp'), (0, ''))
        self.assertEqual(
            self.text(), VERSION + '#line 1\nint both;\n#line 3\n#line 1\nint root;\n#line 4\n'
            'layout(local_size_x = 1) in;\nvoid main() {}\n')

    def test_includes_are_found_below_further_folders_in_order(self):
        for folder in ['first', 'second']:
            (self.root / folder / 'lib').mkdir(parents=True)
            self.write(f'{folder}/lib/b.glsl', f'int {folder};\n')
        self.write('second/lib/a.glsl', '#include "lib/b.glsl"\n')
        self.write('on/a.comp', COMPUTE + '#include "lib/a.glsl"\nvoid main() {}\n')
        self.assertEqual(self.embed('on/a.comp'), (1, f'{self.root}/on/a.comp:3: no file lib/a.glsl\n'))
        self.assertEqual(self.embed('on/a.comp', folders=[self.root / 'first', self.root / 'second']), (0, ''))
        self.assertIn('int first;', self.text())
        self.assertNotIn('int second;', self.text())
        self.assertIn('second/lib/a.glsl', (self.root / 'out.d').read_text())

    def test_depfile_has_every_file(self):
        self.write('a.glsl', 'int a;\n')
        self.write('a.comp', COMPUTE + '#include "a.glsl"\nvoid main() {}\n')
        self.assertEqual(self.embed('a.comp')[0], 0)
        blank = str(self.root).replace(' ', '\\ ')
        self.assertEqual((self.root / 'out.d').read_text(),
                         f'{blank}/out.h: {blank}/a.comp {blank}/a.glsl\n')

    def test_missing_include_is_named_with_its_line(self):
        self.write('a.comp', COMPUTE + '#include "gone.glsl"\n')
        self.assertEqual(self.embed('a.comp'), (1, f'{self.root}/a.comp:3: no file gone.glsl\n'))

    def test_first_line_must_be_the_version(self):
        self.write('a.comp', '// a\n' + COMPUTE)
        code, said = self.embed('a.comp')
        self.assertEqual(code, 1)
        self.assertIn('a.comp:1: the first line must be "#version 450 core"', said)

    def test_shader_outside_the_root_is_refused(self):
        code, said = self.embed('../a.comp')
        self.assertEqual(code, 1)
        self.assertIn(f'is not below {self.root}', said)

    def test_each_permutation_is_compiled(self):
        self.write('a.comp', COMPUTE + 'void main() { int a = B; }\n')
        self.assertEqual(self.embed('a.comp', 'B=1', 'B=2;C'), (0, ''))
        code, said = self.embed('a.comp', 'B=1', 'C=1')
        self.assertEqual(code, 1)
        self.assertIn('a.comp [C=1]:', said)
        self.assertIn(":3: 'B' : undeclared identifier", said)
        self.assertEqual(self.embed('a.comp', 'C=1', glslang='-')[0], 0)


EMBED_GLSL, GLSLANG = sys.argv[1:3]
unittest.main(argv=sys.argv[:1])
