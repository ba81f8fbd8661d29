/* palette.c -- colours whose lightness falls in even steps, for levels on white paper, or rises.
 *
 * viridis, plasma, inferno and magma are those of S. van der Walt and N.  Smith for matplotlib
 * (2015), which they dedicated to the public domain (CC0), cividis that of J.  Nunez, C.  Anderton
 * and R.  Renslow (2018), which all kinds of colour vision see alike; at tenths of their range,
 * between which colours are mixed. */
#include "plot/contour.h"

#include <string.h>

enum { TENTHS = 11, PALETTES = 6 };

/* Dark to light. */
static const char *const shade[PALETTES][TENTHS] = {
    { "#440154", "#482475", "#414487", "#355f8d", "#2a788e", "#21918c", "#22a884", "#44bf70", "#7ad151",
      "#bddf26", "#fde725" },
    { "#00224e", "#083370", "#35456c", "#4f576c", "#666970", "#7d7c78", "#948e77", "#aea371", "#c8b866",
      "#e5cf52", "#fee838" },
    { "#0d0887", "#41049d", "#6a00a8", "#8f0da4", "#b12a90", "#cc4778", "#e16462", "#f2844b", "#fca636",
      "#fcce25", "#f0f921" },
    { "#000004", "#160b39", "#420a68", "#6a176e", "#932667", "#bc3754", "#dd513a", "#f37819", "#fca50a",
      "#f6d746", "#fcffa4" },
    { "#000004", "#140e36", "#3b0f70", "#641a80", "#8c2981", "#b73779", "#de4968", "#f7705c", "#fe9f6d",
      "#fecf92", "#fcfdbf" },
    { "#000000", "#1b1b1b", "#303030", "#474747", "#5e5e5e", "#777777", "#919191", "#ababab", "#c6c6c6",
      "#e2e2e2", "#ffffff" },
};
const char *const ss_palettes[] = {
    "viridis", "cividis", "plasma", "inferno", "magma", "grey",
    "viridis_r", "cividis_r", "plasma_r", "inferno_r", "magma_r", "grey_r", NULL
};

/* Its place among ss_palettes; those from PALETTES on have a light loudest level. */
static int
find(const char *name)
{
    int i = 0;
    while (ss_palettes[i] != NULL && strcmp(ss_palettes[i], name) != 0)
        i++;
    return i;
}

int
ss_palette_is_known(const char *name)
{
    return ss_palettes[find(name)] != NULL;
}

const char *
ss_palette_ground(const char *name)
{
    int i = find(name);
    return i >= PALETTES ? shade[i - PALETTES][0] : NULL;
}

void
ss_palette_write(FILE *out, const char *name, int areas)
{
    int i = find(name);
    int lightest = areas ? TENTHS - 1 : TENTHS - 3;     /* a line of the last two is lost on white */
    fputs("colours = \"", out);
    for (int k = 0; k <= lightest; k++)
        ss_print(out, "%g '%s'%s", (double)k / lightest, shade[i % PALETTES][i < PALETTES ? lightest - k : k],
                k < lightest ? ", " : "\"\n");
}
