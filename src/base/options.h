/* options.h -- options whose structure may grow at its end.
 *
 * The first field of each public options structure is `size_t size`: its size in the header with which
 * the caller was compiled.  ss_x_opts_init writes it; fields that were added later keep their defaults. */
#ifndef OPTIONS_H
#define OPTIONS_H

#include <string.h>
#include "base/error.h"

/* Fill in the first `size` bytes of the caller's options, if there is room for the size; the library's own have `known`
 * bytes. */
static inline void
ss_options_init(void *opts, size_t size, const void *defaults, size_t known)
{
    if (opts == NULL || size < sizeof size)
        return;
    memset(opts, 0, size);
    memcpy(opts, defaults, size < known ? size : known);
    memcpy(opts, &size, sizeof size);
}

/* The function ss_x_opts_init of options with these defaults. */
#define SS_OPTIONS(type, defaults) \
    void type##_init(type *opts, size_t size) { ss_options_init(opts, size, &(defaults), sizeof (defaults)); }

/* own becomes the caller's options, with defaults where the caller's header had no field; given may be
 * NULL.  SS_EINVAL: they were not initialised, or have fields that this library does not know. */
static inline ss_status
ss_options_take(void *own, size_t known, const void *defaults, const void *given, ss_error *err)
{
    size_t size = known;
    memcpy(own, defaults, known);
    if (given != NULL) {
        memcpy(&size, given, sizeof size);
        if (size < sizeof size || size > known)
            return ss_fail(err, SS_EINVAL, "options of %zu bytes, where this library has %zu: "
                           "were they initialised?", size, known);
        memcpy(own, given, size);
    }
    memcpy(own, &known, sizeof known);
    return SS_OK;
}

#endif
