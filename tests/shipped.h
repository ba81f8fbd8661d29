/* shipped.h -- the shipped scenes, read: for tests and benches. */
#ifndef SHIPPED_H
#define SHIPPED_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <stickslip.h>

/* Ends the program, with a word, if it cannot be read. */
static inline ss_scene
read_shipped(const ss_shipped_scene *shipped)
{
    ss_scene scene;
    ss_error err = { "" };
    FILE *in = fmemopen((void *)shipped->text, strlen(shipped->text), "r");
    if (in == NULL || ss_scene_read(&scene, in, shipped->name, &err) != SS_OK) {
        fprintf(stderr, "%s: %s\n", shipped->name, err.text);
        exit(1);
    }
    fclose(in);
    return scene;
}

/* name is one of theirs. */
static inline ss_scene
read_shipped_named(const char *name)
{
    const ss_shipped_scene *s = ss_shipped_scenes;
    while (strcmp(s->name, name) != 0)
        s++;
    return read_shipped(s);
}

#endif
