// SPDX-License-Identifier: MIT
#include <pass/paraboloid.h>

enum { UNIT = 4, EYES = 4 };

void ag_paraboloid_bind(const fg_run *run, const ag_paraboloid_pass *pass)
{
    fg_gl_sample(run, UNIT, pass->maps, FG_GL_NEAREST);
    fg_gl_storage(run, EYES, pass->eyes);
}
