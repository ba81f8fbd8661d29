/* list.h -- room in a list that grows. */
#ifndef LIST_H
#define LIST_H

#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

/* The list, moved if need be, with room for one more behind its n of size bytes each: it doubles.
 * NULL: no memory; the list is as it was. */
static inline void *
ss_list_room(void *list, size_t *room, size_t n, size_t size)
{
    if (n < *room)
        return list;
    size_t more = 2 * *room + 64;
    void *longer = more <= SIZE_MAX / size ? realloc(list, more * size) : NULL;
    if (longer != NULL)
        *room = more;
    return longer;
}

#endif
