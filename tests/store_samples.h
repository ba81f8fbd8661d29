/* store_samples.h -- hand samples of a signal to a writer: for tests. */
#ifndef STORE_SAMPLES_H
#define STORE_SAMPLES_H

#include <stickslip.h>

/* n samples of each column, from number `first` on; there are at most 16 columns. */
static inline ss_status
store_samples(ss_writer *writer, const ss_signal *signal, size_t first, size_t n, ss_error *err)
{
    double *column[16];
    for (size_t c = 0; c < signal->head->n_columns; c++)
        column[c] = signal->values + c * signal->n + first;
    return ss_writer_rows(writer, column, n, err);
}

#endif
