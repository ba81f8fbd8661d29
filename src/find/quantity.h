/* quantity.h -- the physical quantity of a column, by its unit or its name. */
#ifndef QUANTITY_H
#define QUANTITY_H

#include <stickslip/signal.h>

typedef enum column_quantity {
    QUANTITY_UNKNOWN, QUANTITY_FORCE, QUANTITY_DISPLACEMENT,
    QUANTITY_MOTION             /* velocity or acceleration, or it is not known which of the three */
} column_quantity;

column_quantity ss_column_quantity(const ss_column *column);

#endif
