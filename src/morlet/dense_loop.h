/* dense_loop.h -- the loop of dense.c, for vectors of WIDTH doubles, with HELD rows in registers.
 *
 * Included once for each of them, with ROWS_NAME, WIDTH, HELD and TARGET defined. */
#define ROWS_JOIN2(a, b) a##b
#define ROWS_JOIN(a, b) ROWS_JOIN2(a, b)
#define VECTOR ROWS_JOIN(ROWS_NAME, _vector)

enum { ROWS_JOIN(ROWS_NAME, _parts) = LANES / WIDTH };
typedef double VECTOR __attribute__((vector_size(8 * WIDTH)));

TARGET static void
ROWS_NAME(const rows *r, const double *v, const double *weight, double e[][2], double *w,
          double most[LANES])
{
    enum { PARTS = ROWS_JOIN(ROWS_NAME, _parts) };
    for (size_t first = 0; first < ROWS; first += HELD) {
        const double *from = v + 2 * first * r->apart;
        VECTOR re[HELD][PARTS] = { 0 }, im[HELD][PARTS] = { 0 };
        for (int t = 0; t < r->taps; t++) {
            VECTOR k[PARTS];
            memcpy(k, weight + t * LANES, sizeof k);
            UNROLL
            for (size_t i = 0; i < HELD; i++)
                UNROLL
                for (size_t p = 0; p < PARTS; p++) {
                    re[i][p] += k[p] * from[2 * ((size_t)t + i * r->apart)];
                    im[i][p] += k[p] * from[2 * ((size_t)t + i * r->apart) + 1];
                }
        }
        UNROLL
        for (size_t i = 0; i < HELD; i++) {
            double x[LANES], y[LANES];
            memcpy(x, re[i], sizeof x);
            memcpy(y, im[i], sizeof y);
            put_lanes(r, x, y, e[first + i], w + (first + i) * r->stride, most);
        }
    }
}

#undef ROWS_JOIN2
#undef ROWS_JOIN
#undef VECTOR
#undef ROWS_NAME
#undef WIDTH
#undef HELD
#undef TARGET
