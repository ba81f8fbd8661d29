/* dense_loop.h -- the loop of dense.c, for vectors of WIDTH numbers: write the groups g ... end - 1, each of ROWS
 * rows.
 *
 * Included once for each width, with LOOP, WIDTH and TARGET defined. */
TARGET static void
LOOP(const weights *d, const double *v, size_t g, size_t end, const carrier *turning, double *w)
{
    typedef double lanes __attribute__((vector_size(WIDTH * sizeof(double)), may_alias));
    enum { PARTS = LANES / WIDTH };
    const size_t blocks = d->blocks, points = d->points, taps = d->taps;
    for (; g < end; g++) {
        const lanes *weight = (const lanes *)d->weight, *place = (const lanes *)turning->places;
        double e[ROWS][2];
        for (size_t i = 0, row = g * ROWS; i < ROWS; i++, row++)
            multiply(turning->far[row / (ROOT * ROOT)], turning->near[row % (ROOT * ROOT)], e[i]);
        for (size_t m = 0; m < blocks; m++, weight += taps * PARTS, place += 2 * PARTS)
            for (size_t p = 0; p < PARTS; p++) {
                const double *from = v + 2 * (g * ROWS * points + d->late[m]);
                lanes re[ROWS] = { 0 }, im[ROWS] = { 0 };
                for (size_t t = 0; t < taps; t++)
                    UNROLL
                    for (size_t i = 0; i < ROWS; i++) {
                        re[i] += weight[t * PARTS + p] * from[2 * (t + i * points)];
                        im[i] += weight[t * PARTS + p] * from[2 * (t + i * points) + 1];
                    }
                UNROLL
                for (size_t i = 0; i < ROWS; i++) {
                    const lanes x = re[i] * e[i][0] - im[i] * e[i][1], y = im[i] * e[i][0] + re[i] * e[i][1];
                    const lanes c = place[p], s = place[PARTS + p], now[2] = { x * c - y * s, y * c + x * s };
                    double *to = w + 2 * ((i * blocks + m) * LANES + p * WIDTH);
                    for (size_t l = 0; l < WIDTH; l++) {
                        to[2 * l] = now[0][l];
                        to[2 * l + 1] = now[1][l];
                    }
                }
            }
        w += 2 * ROWS * blocks * LANES;
    }
}

#undef LOOP
#undef WIDTH
#undef TARGET
