/* models.h -- the list of friction models.
 *
 * A new model is a file that defines such a table, and a row in the list. */
#ifndef MODELS_H
#define MODELS_H

#include "scene/model.h"

#define MODEL_LIST(row) \
    row(coulomb) \
    row(state_variable) \
    row(compliant) \
    row(stribeck) \
    row(lugre) \
    row(bouc_wen) \
    row(rate_and_state)

#define MODEL_DECLARATION(name) extern const ss_model ss_##name##_model;
MODEL_LIST(MODEL_DECLARATION)
#undef MODEL_DECLARATION
#define MODEL_NUMBER(name) MODEL_##name,
enum { MODEL_LIST(MODEL_NUMBER) MODELS };
#undef MODEL_NUMBER

/* Begins the table of a model, MODEL(coulomb) = { ... };.  Without a row of the list it does not compile. */
#define MODEL(name) \
    enum { ROW_OF_##name = MODEL_##name }; \
    const ss_model ss_##name##_model

#endif
