/* events_writer.c -- write the events of a run as datasets of one length in /events. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "io/hdf5/groups.h"
#include "motion/kind.h"

#define KIND_LENGTH 8           /* "reverse" and a NUL */

ss_status
ss_h5_write_events(h5_file *file, const ss_event *event, size_t n)
{
    static const char none;
    hid_t group = ss_h5_new_group(file->id, "events"), text = H5Tcopy(H5T_C_S1);
    double *real = malloc((3 * n + 1) * sizeof *real);      /* t, x and v of each event */
    char *kind = calloc(n + 1, KIND_LENGTH);
    int *direction = malloc((n + 1) * sizeof *direction);
    ss_status status = real && kind && direction ? SS_OK : SS_ENOMEM;
    H5Tset_size(text, KIND_LENGTH);
    if (status == SS_OK && group < 0)
        status = ss_h5_fail_write(file, 0, "/events");
    for (size_t i = 0; status == SS_OK && i < n; i++) {
        const double row[3] = { event[i].t, event[i].x, event[i].v };
        memcpy(real + 3 * i, row, sizeof row);
        snprintf(kind + i * KIND_LENGTH, KIND_LENGTH, "%s", ss_event_kind_name(event[i].kind));
        direction[i] = event[i].direction;
    }
    const h5_dataset v[] = {
        { "t", "s", "time", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, real, 0, 3, 0, 0 },
        { "kind", &none, "what begins: stick, slip, or slip the other way", text, text, kind, 0, 1,
          0, 0 },
        { "x", "m", "displacement", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, real, 1, 3, 0, 0 },
        { "v", "m/s", "velocity", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, real, 2, 3, 0, 0 },
        { "direction", "1", "sign of the slip that begins, or ended at a stick", H5T_STD_I8LE,
          H5T_NATIVE_INT, direction, 0, 1, 0, 0 },
    };
    if (status == SS_OK)
        status = ss_h5_write_lists(file, group, v, sizeof v / sizeof *v, n);
    H5Tclose(text);
    H5Gclose(group);
    free(real);
    free(kind);
    free(direction);
    return status;
}
