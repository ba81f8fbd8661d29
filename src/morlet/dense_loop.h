/* dense_loop.h -- the loop of dense.c, for vectors of WIDTH numbers of type REAL.
 *
 * Included once for each of them, with LOOP, REAL, WIDTH, TARGET and PAIR(p) defined: a vector that
 * repeats the two numbers at p. */
#define LOOP_JOIN2(a, b) a##b
#define LOOP_JOIN(a, b) LOOP_JOIN2(a, b)
#define VECTOR LOOP_JOIN(LOOP, _vector)
#define SWAP_JOIN(width) LOOP_JOIN(SWAP_, width)
#define PARTS (2 * LANES / WIDTH)               /* vectors of a block */
#define HELD (8 / PARTS < ROWS ? 8 / PARTS : ROWS)  /* rows in registers */

typedef REAL VECTOR __attribute__((vector_size(WIDTH * sizeof(REAL))));

/* Re and im of each place change places. */
TARGET static inline VECTOR
LOOP_JOIN(LOOP, _swap)(VECTOR x)
{
    return (VECTOR)SWAP_JOIN(WIDTH);
}

/* WIDTH/2 coefficients. */
TARGET static inline void
LOOP_JOIN(LOOP, _put)(VECTOR x, double factor, double *w)
{
    if (sizeof x == WIDTH * sizeof *w) {
        memcpy(w, &x, sizeof x);
        return;
    }
    REAL part[WIDTH];
    memcpy(part, &x, sizeof part);
    for (int i = 0; i < WIDTH; i++)
        w[i] = part[i] * factor;
}

/* x times a carrier, c being its re, re and s its -im, im. */
TARGET static inline VECTOR
LOOP_JOIN(LOOP, _turn)(VECTOR x, VECTOR c, VECTOR s)
{
    return x * c + LOOP_JOIN(LOOP, _swap)(x) * s;
}

/* The largest |W|^2, for each lane. */
TARGET static inline void
LOOP_JOIN(LOOP, _compare)(const VECTOR x[PARTS], REAL largest[2 * LANES])
{
    UNROLL
    for (size_t p = 0; p < PARTS; p++) {
        VECTOR most, size = x[p] * x[p];
        size += LOOP_JOIN(LOOP, _swap)(size);
        memcpy(&most, largest + p * WIDTH, sizeof most);
        __typeof__(size > most) more = size > most;
        most = (VECTOR)((more & (__typeof__(more))size) | (~more & (__typeof__(more))most));
        memcpy(largest + p * WIDTH, &most, sizeof most);
    }
}

/* LANES places of HELD rows. */
TARGET static inline void
LOOP_JOIN(LOOP, _sum)(const REAL *v, size_t points, const REAL *weight, int taps,
                      VECTOR to[HELD][PARTS])
{
    VECTOR sum[HELD][PARTS] = { 0 };
    for (int t = 0; t < taps; t++) {
        VECTOR k[PARTS];
        memcpy(k, weight + t * 2 * LANES, sizeof k);
        UNROLL
        for (size_t i = 0; i < HELD; i++) {
            VECTOR point = PAIR(v + 2 * ((size_t)t + i * points));
            UNROLL
            for (size_t p = 0; p < PARTS; p++)
                sum[i][p] += k[p] * point;
        }
    }
    UNROLL
    for (size_t i = 0; i < HELD; i++)
        UNROLL
        for (size_t p = 0; p < PARTS; p++)
            to[i][p] = sum[i][p];
}

TARGET static void
LOOP(const weights *d, const void *series, size_t g, size_t end, const carrier *turning,
     double factor, double *w, double most[2 * LANES])
{
    const REAL *v = series, *all_weights = d->weight, *places = turning->places;
    const size_t blocks = d->blocks, points = d->points, *late = d->late;
    const int taps = d->taps;
    REAL largest[2 * LANES] = { 0 };
    for (; g < end; g++) {
        REAL e[ROWS][4];            /* of each row, the carrier's re, re, -im, im */
        for (size_t i = 0; i < ROWS; i++) {
            double turn[2];
            row_carrier(turning, g * ROWS + i, turn);
            e[i][0] = e[i][1] = (REAL)turn[0];
            e[i][2] = -(e[i][3] = (REAL)turn[1]);
        }
        for (size_t j = 0; j < blocks * (ROWS / HELD); j++) {
            size_t m = j / (ROWS / HELD), first = j % (ROWS / HELD) * HELD;
            VECTOR sum[HELD][PARTS];
            const REAL *place = places + m * 4 * LANES;
            LOOP_JOIN(LOOP, _sum)(v + 2 * ((g * ROWS + first) * points + late[m]), points,
                                  all_weights + m * (size_t)taps * 2 * LANES, taps, sum);
            if (first == 0)
                LOOP_JOIN(LOOP, _compare)(sum[0], largest);
            UNROLL
            for (size_t i = 0; i < HELD; i++) {
                VECTOR c = PAIR(e[first + i]), s = PAIR(e[first + i] + 2);
                double *to = w + 2 * ((first + i) * blocks + m) * LANES;
                UNROLL
                for (size_t p = 0; p < PARTS; p++) {
                    VECTOR x = LOOP_JOIN(LOOP, _turn)(sum[i][p], c, s), own[2];
                    memcpy(&own[0], place + p * WIDTH, sizeof own[0]);
                    memcpy(&own[1], place + 2 * LANES + p * WIDTH, sizeof own[1]);
                    x = LOOP_JOIN(LOOP, _turn)(x, own[0], own[1]);
                    LOOP_JOIN(LOOP, _put)(x, factor, to + p * WIDTH);
                }
            }
        }
        w += 2 * ROWS * blocks * LANES;
    }
    for (size_t l = 0; l < 2 * LANES; l++)
        most[l] = largest[l];
}

#undef PARTS
#undef HELD
#undef LOOP_JOIN2
#undef LOOP_JOIN
#undef SWAP_JOIN
#undef VECTOR
#undef LOOP
#undef REAL
#undef WIDTH
#undef TARGET
#undef PAIR
