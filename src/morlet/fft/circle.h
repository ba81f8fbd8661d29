/* circle.h -- the points about the ends of a circle in fft.c, of numbers of type REAL.
 *
 * Included once for each precision, with REAL and NAMED(name) defined. */

/* Make the points before and after the circle repeat it. */
static void
NAMED(close_circle)(REAL *v, size_t length)
{
    for (size_t i = 0; i < MARGIN; i++) {
        size_t left = (length - 1 - i % length), right = i % length;
        memcpy(v - 2 * (i + 1), v + 2 * left, 2 * sizeof *v);
        memcpy(v + 2 * (length + i), v + 2 * right, 2 * sizeof *v);
    }
}
