/* style.h -- the colours of pictures.
 *
 * Lines have the colours of Okabe and Ito (2008), which readers with any kind of colour vision tell apart.
 * palette.c has the colours between levels, map.c those of a map's regions and lines. */
#ifndef STYLE_H
#define STYLE_H

#define BLACK "#000000"
#define BLUE "#0072b2"
#define VERMILION "#d55e00"
#define GREEN "#009e73"
#define PURPLE "#cc79a7"
#define ORANGE "#e69f00"
#define SKY_BLUE "#56b4e9"

#define GRID_COLOUR "#dddddd"
#define ZERO_COLOUR "#999999"           /* the line at 0 */

/* Contours: lines from high levels to low ones, and what is drawn over them. */
#define LEVEL_COLOURS "0 '#7ad151', 0.3 '#22a884', 0.55 '#2a788e', 0.8 '#414487', 1 '#440154'"
#define LEVEL_COLOUR "#444444"          /* lines over filled levels */
#define CONE_COLOUR "#e4e4e4"
#define MARK_COLOUR "#cc3311"           /* features and ridges */
#define SHADE_COLOUR "#f2ccc4"          /* transitions over time */

#endif
