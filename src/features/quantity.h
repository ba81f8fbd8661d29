/* quantity.h -- the physical quantity of a column, by its unit or its name. */
#ifndef QUANTITY_H
#define QUANTITY_H

#include <stickslip/signal.h>

typedef enum ss_quantity {
    QUANTITY_UNKNOWN, QUANTITY_FORCE, QUANTITY_MOTION   /* displacement, velocity or acceleration */
} ss_quantity;

ss_quantity ss_quantity_of(const ss_column *column);

#endif
