// SPDX-License-Identifier: MIT
// To be preloaded where apitrace records a program that uses EGL. Its EGL tracer stands in for
// libGL, too, but has no GLX; libepoxy 1.5.10 asks libGL for glXGetCurrentContext() and aborts
// where there is none.
#include <dlfcn.h>
#include <stddef.h>
#include <string.h>

static void *no_context(void)
{
    return NULL;
}

__attribute__((constructor)) static void begin(void)
{
    void *(*answer)(void) = no_context;
    void *entry = dlsym(RTLD_DEFAULT, "epoxy_glXGetCurrentContext"); // a variable
    if (entry)
        memcpy(entry, &answer, sizeof answer);
}
