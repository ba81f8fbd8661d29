/* hdf5.c -- HDF5 when a file needs it.
 *
 * HDF5 brings some 35 libraries, and loading these takes more processor time than most runs of a
 * tool.  So tools are not linked with what needs it (src/io/hdf5): ss_store_calls opens the shared
 * library libstickslip and returns the table of functions there. */
#include <dlfcn.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>
#include <stickslip/store.h>

#define LIBRARY "libstickslip.so." SS_VERSION

/* Open the library beside the tool, in the build tree or installed, or where it was to be installed, before any
 * other of its name.  It may be missing where a tool was copied alone. */
const struct ss_store_calls *
ss_store_calls(ss_error *err)
{
    static const struct ss_store_calls *calls;
    static const char *const place[] = { "/../", "/../lib/" };
    char tool[PATH_MAX], path[PATH_MAX + 64];
    void *library = NULL;
    if (calls != NULL)
        return calls;
    ssize_t n = readlink("/proc/self/exe", tool, sizeof tool - 1);
    tool[n > 0 ? n : 0] = '\0';
    char *slash = strrchr(tool, '/');
    for (size_t i = 0; slash != NULL && library == NULL && i < sizeof place / sizeof *place; i++) {
        *slash = '\0';
        snprintf(path, sizeof path, "%s%s%s", tool, place[i], LIBRARY);
        library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    }
    if (library == NULL)
        library = dlopen(LIBDIR "/" LIBRARY, RTLD_NOW | RTLD_LOCAL);
    if (library == NULL)
        library = dlopen(LIBRARY, RTLD_NOW | RTLD_LOCAL);
    const struct ss_store_calls *(*function)(ss_error *);
    void *found = library != NULL ? dlsym(library, "ss_store_calls") : NULL;
    *(void **)&function = found;            /* the form of dlsym(3), as C has no such conversion */
    if (found != NULL)
        return calls = function(err);
    if (err != NULL)
        snprintf(err->text, sizeof err->text,
                 "HDF5 files need the library that is installed with the tools: %s", dlerror());
    return NULL;
}
