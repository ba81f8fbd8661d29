/* hdf5.c -- HDF5 when a file needs it.
 *
 * HDF5 brings some 35 libraries, and loading these takes more processor time than most runs of a
 * tool.  So tools are not linked with the store (src/io/hdf5): these functions have its names, open
 * the shared library libstickslip where the store is, and call the same function there. */
#include <dlfcn.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>
#include <stickslip/store.h>

#define LIBRARY "libstickslip.so." SS_VERSION

/* Open the library beside the tool, in the build tree or installed, or where it was to be installed, before any other
 * of its name. */
static void *
open_library(void)
{
    static const char *const place[] = { "/../", "/../lib/" };
    char tool[PATH_MAX], path[PATH_MAX + 64];
    ssize_t n = readlink("/proc/self/exe", tool, sizeof tool - 1);
    void *library = NULL;
    tool[n > 0 ? n : 0] = '\0';
    char *slash = strrchr(tool, '/');
    for (size_t i = 0; slash != NULL && library == NULL && i < sizeof place / sizeof *place; i++) {
        *slash = '\0';
        snprintf(path, sizeof path, "%s%s%s", tool, place[i], LIBRARY);
        library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    }
    if (library == NULL)
        library = dlopen(LIBDIR "/" LIBRARY, RTLD_NOW | RTLD_LOCAL);
    return library != NULL ? library : dlopen(LIBRARY, RTLD_NOW | RTLD_LOCAL);
}

/* *function becomes the store's function with this name.  Returns 0, with the reason, if there is none. */
static int
find(void *function, const char *name, ss_error *err)
{
    static void *library;
    if (library == NULL)
        library = open_library();
    void *found = library != NULL ? dlsym(library, name) : NULL;
    *(void **)function = found;             /* the form of dlsym(3), as C has no such conversion */
    if (found == NULL && err != NULL)
        snprintf(err->text, sizeof err->text,
                 "HDF5 files need the library that is installed with the tools: %s", dlerror());
    return found != NULL;
}

#define FORWARD(name, parameters, arguments) \
    ss_status \
    name parameters \
    { \
        ss_status (*function) parameters; \
        return find(&function, #name, err) ? function arguments : SS_EIO; \
    }

FORWARD(ss_store_write, (const char *path, const ss_record *record, ss_error *err), (path, record, err))
FORWARD(ss_store_writer_new,
        (ss_store_writer **out, const char *path, const ss_header *signal, const ss_coefficients *grid,
         ss_error *err),
        (out, path, signal, grid, err))
FORWARD(ss_store_writer_signal,
        (ss_store_writer *writer, double *const column[], size_t n, ss_error *err), (writer, column, n, err))
FORWARD(ss_store_writer_rows,
        (ss_store_writer *writer, const ss_scale *scale, size_t first, size_t n, const double *w,
         size_t samples, ss_error *err),
        (writer, scale, first, n, w, samples, err))
FORWARD(ss_store_writer_note,
        (ss_store_writer *writer, const char *key, const char *value, ss_error *err),
        (writer, key, value, err))
FORWARD(ss_store_writer_end, (ss_store_writer *writer, size_t samples, ss_error *err), (writer, samples, err))
FORWARD(ss_store_signal_reader,
        (ss_reader **out, const char *path, const char *dataset, const ss_read_opts *opts,
         ss_error *err),
        (out, path, dataset, opts, err))
FORWARD(ss_store_read_coefficients, (ss_coefficients **out, const char *path, ss_error *err), (out, path, err))
FORWARD(ss_store_open_coefficients, (ss_coefficients **out, const char *path, ss_error *err), (out, path, err))

int
ss_store_has_signal(const char *path)
{
    int (*function)(const char *);
    return find(&function, "ss_store_has_signal", NULL) && function(path);
}

/* If no writer was made, the library need not be opened to free it. */
void
ss_store_writer_free(ss_store_writer *writer)
{
    void (*function)(ss_store_writer *);
    if (writer != NULL && find(&function, "ss_store_writer_free", NULL))
        function(writer);
}
