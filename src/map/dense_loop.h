/* dense_loop.h -- the loop of dense.c, for vectors of WIDTH numbers.
 *
 * Included once for each width, with LOOP, WIDTH, TARGET and PAIR(p) defined: a vector that repeats
 * the two numbers at p. */
#define LOOP_JOIN2(a, b) a##b
#define LOOP_JOIN(a, b) LOOP_JOIN2(a, b)
#define VECTOR LOOP_JOIN(LOOP, _vector)
#define SWAP_JOIN(width) LOOP_JOIN(SWAP_, width)

typedef double VECTOR __attribute__((vector_size(WIDTH * sizeof(double))));

/* Re and im of each place change places. */
TARGET static inline VECTOR
LOOP_JOIN(LOOP, _swap)(VECTOR x)
{
    return (VECTOR)SWAP_JOIN(WIDTH);
}

/* x times a carrier, c being its re, re and s its -im, im. */
TARGET static inline VECTOR
LOOP_JOIN(LOOP, _turn)(VECTOR x, VECTOR c, VECTOR s)
{
    return x * c + LOOP_JOIN(LOOP, _swap)(x) * s;
}

/* Sums and their output in one function: in several it was 5 % slower (gcc 12). */
TARGET static void
LOOP(const weights *d, const double *v, size_t g, size_t end, const carrier *turning, double *w)
{
    enum { PARTS = 2 * LANES / WIDTH, HELD = 8 / PARTS < ROWS ? 8 / PARTS : ROWS };
    const size_t blocks = d->blocks, points = d->points, *late = d->late;
    const int taps = d->taps;
    for (; g < end; g++) {
        double e[ROWS][4];
        row_carriers(turning, g, e);
        for (size_t m = 0; m < blocks; m++) {
            const double *weight = d->weight + m * (size_t)taps * 2 * LANES;
            const double *of_places = turning->places + m * 4 * LANES;
            double *to = w + 2 * m * LANES;
            for (size_t first = 0; first < ROWS; first += HELD) {
                const double *from = v + 2 * ((g * ROWS + first) * points + late[m]);
                VECTOR sum[HELD][PARTS] = { 0 };
                for (int t = 0; t < taps; t++) {
                    VECTOR k[PARTS];
                    memcpy(k, weight + t * 2 * LANES, sizeof k);
                    UNROLL
                    for (size_t i = 0; i < HELD; i++) {
                        VECTOR point = PAIR(from + 2 * ((size_t)t + i * points));
                        UNROLL
                        for (size_t p = 0; p < PARTS; p++)
                            sum[i][p] += k[p] * point;
                    }
                }
                UNROLL
                for (size_t i = 0; i < HELD; i++) {
                    VECTOR c = PAIR(e[first + i]), s = PAIR(e[first + i] + 2);
                    UNROLL
                    for (size_t p = 0; p < PARTS; p++) {
                        VECTOR x = sum[i][p], place[2];
                        memcpy(&place[0], of_places + p * WIDTH, sizeof place[0]);
                        memcpy(&place[1], of_places + 2 * LANES + p * WIDTH, sizeof place[1]);
                        x = LOOP_JOIN(LOOP, _turn)(x, c, s);
                        x = LOOP_JOIN(LOOP, _turn)(x, place[0], place[1]);
                        memcpy(to + 2 * (first + i) * blocks * LANES + p * WIDTH, &x, sizeof x);
                    }
                }
            }
        }
        w += 2 * ROWS * blocks * LANES;
    }
}

#undef LOOP_JOIN2
#undef LOOP_JOIN
#undef SWAP_JOIN
#undef VECTOR
#undef LOOP
#undef WIDTH
#undef TARGET
#undef PAIR
