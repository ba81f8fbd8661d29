/* shipped.h -- the shipped scenes, read: for tests and benches. */
#ifndef SHIPPED_H
#define SHIPPED_H

#include <stdio.h>
#include <stdlib.h>
#include <stickslip.h>

/* Ends the program, with a word, if it cannot be read. */
static inline ss_scene
read_shipped_named(const char *name)
{
    ss_scene scene;
    ss_error err = { 0 };
    if (ss_scene_read(&scene, NULL, name, NULL, 0, &err) != SS_OK) {
        fprintf(stderr, "%s\n", err.text);
        exit(1);
    }
    return scene;
}

static inline ss_scene
read_shipped(const ss_shipped_scene *shipped)
{
    return read_shipped_named(shipped->name);
}

/* The shipped slider, pulled at U over a surface that moves at S. */
static inline ss_scene
read_slider(double U, double S)
{
    ss_scene s = read_shipped_named("pulled-slider");
    s.base_velocity = U;
    s.surface_velocity = S;
    return s;
}

#endif
