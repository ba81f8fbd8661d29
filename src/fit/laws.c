/* laws.c -- the friction laws that a measured motion may drive: a row for each. */
#include <math.h>
#include "fit/driven.h"
#include "scene/key.h"

#define AMOUNT { "friction", "N" }
#define STIFFNESS { "contact_stiffness", "N/m" }
#define OTHER_SIDE { "friction_negative", "N" }, { "contact_stiffness_negative", "N/m" }
#define FORM { "exponent", "" }, { "beta_fraction", "" }

static void
coulomb(double number[], const double u[], const double c[])
{
    (void)u;
    number[0] = c[0];
}

static void
stribeck(double number[], const double u[], const double c[])
{
    number[0] = c[0];
    number[1] = c[0] + c[1];
    number[2] = exp(u[SPEED]);
    number[3] = exp(u[SHAPE]);
}

/* The amplitudes of an elastic contact are its stiffnesses. */
static void
compliant(double number[], const double u[], const double c[])
{
    number[0] = c[0] * exp(u[LENGTH]);
    number[1] = c[0];
}

static void
compliant_gap(double number[], const double u[], const double c[])
{
    compliant(number, u, c);
    number[2] = exp(u[GAP]);
    number[3] = c[1] * exp(u[LENGTH] + u[OTHER_LENGTH]);
    number[4] = c[1];
}

static void
bouc_wen(double number[], const double u[], const double c[])
{
    number[0] = c[0];
    number[1] = c[0] / exp(u[LENGTH]);
    number[2] = exp(u[EXPONENT]);
    number[3] = u[BETA];
}

static void
bouc_wen_gap(double number[], const double u[], const double c[])
{
    bouc_wen(number, u, c);
    number[4] = exp(u[GAP]);
    number[5] = c[1];
    number[6] = c[1] / exp(u[LENGTH]);
}

static void
lugre(double number[], const double u[], const double c[])
{
    number[0] = c[0];
    number[1] = c[0] * exp(u[RISE]);
    number[2] = exp(u[SPEED]);
    number[3] = c[0] / exp(u[LENGTH]);
    number[4] = c[1];
}

/* The amplitudes are N mu0, N a and N b at the rms speed, which is the unit; N is that of mu0 = 1. */
static void
rate_and_state(double number[], const double u[], const double c[])
{
    number[0] = c[0];
    number[1] = number[2] = 1;
    number[3] = c[1] / c[0];
    number[4] = c[2] / c[0];
    number[5] = exp(u[LENGTH]);
}

#define BIT(name) (1u << (name))
enum {
    IS_LINEAR, IS_COULOMB, IS_STRIBECK, IS_COMPLIANT, IS_DAHL, IS_LUGRE, IS_COMPLIANT_GAP, IS_BOUC_WEN,
    IS_BOUC_WEN_GAP, IS_RATE_AND_STATE
};
#define SIMPLE BIT(IS_LINEAR) | BIT(IS_COULOMB)
#define SMALL (-4.6)                /* the logarithm of a length that a contact does not show */

static const driven_law list[] = {
    [IS_LINEAR] = { .name = "linear", .number = { { NULL, NULL } } },
    [IS_COULOMB] = { .name = "coulomb", .model = "coulomb", .parts = 1, .numbers = coulomb, .number = { AMOUNT },
        .contains = BIT(IS_LINEAR), .held = { [LENGTH] = SMALL, [GAP] = SMALL } },
    [IS_STRIBECK] = { .name = "stribeck", .model = "stribeck", .parts = 2, .numbers = stribeck,
        .number = { AMOUNT, { "static_friction", "N" }, { "stribeck_velocity", "m/s" },
                    { "stribeck_exponent", "" } }, .word = { "stribeck_shape", "exponential" },
        .contains = SIMPLE, .free = BIT(SPEED) | BIT(SHAPE), .held = { [LENGTH] = SMALL } },
    [IS_COMPLIANT] = { .name = "compliant", .is_even = 1, .model = "compliant", .parts = 1, .numbers = compliant,
        .number = { AMOUNT, STIFFNESS }, .contains = SIMPLE, .free = BIT(LENGTH),
        .held = { [EXPONENT] = 2, [GAP] = SMALL, [BETA] = 0.5 } },
    [IS_DAHL] = { .name = "dahl", .is_even = 1, .model = "bouc-wen", .parts = 1, .numbers = bouc_wen,
        .number = { AMOUNT, STIFFNESS, FORM }, .contains = SIMPLE, .free = BIT(LENGTH),
        .held = { [EXPONENT] = 0, [GAP] = SMALL, [BETA] = 1 } },
    [IS_LUGRE] = { .name = "lugre", .is_even = 1, .model = "lugre", .parts = 2, .numbers = lugre,
        .number = { AMOUNT, { "static_friction", "N" }, { "stribeck_velocity", "m/s" },
                    { "bristle_stiffness", "N/m" }, { "bristle_damping", "N s/m" } },
        .contains = SIMPLE | BIT(IS_STRIBECK) | BIT(IS_DAHL), .free = BIT(LENGTH) | BIT(RISE) | BIT(SPEED) },
    [IS_COMPLIANT_GAP] = { .name = "compliant-gap", .model = "compliant", .parts = 2, .numbers = compliant_gap,
        .number = { AMOUNT, STIFFNESS, { "gap", "m" }, OTHER_SIDE }, .contains = SIMPLE | BIT(IS_COMPLIANT),
        .free = BIT(LENGTH) | BIT(OTHER_LENGTH) | BIT(GAP), .held = { [EXPONENT] = 2, [BETA] = 0.5 } },
    [IS_BOUC_WEN] = { .name = "bouc-wen", .is_even = 1, .model = "bouc-wen", .parts = 1, .numbers = bouc_wen,
        .number = { AMOUNT, STIFFNESS, FORM }, .contains = SIMPLE | BIT(IS_COMPLIANT) | BIT(IS_DAHL),
        .free = BIT(LENGTH) | BIT(EXPONENT) | BIT(BETA), .held = { [GAP] = SMALL } },
    [IS_BOUC_WEN_GAP] = { .name = "bouc-wen-gap", .model = "bouc-wen", .parts = 2, .numbers = bouc_wen_gap,
        .number = { AMOUNT, STIFFNESS, FORM, { "gap", "m" }, OTHER_SIDE },
        .contains = SIMPLE | BIT(IS_COMPLIANT) | BIT(IS_DAHL) | BIT(IS_BOUC_WEN) | BIT(IS_COMPLIANT_GAP),
        .free = BIT(LENGTH) | BIT(EXPONENT) | BIT(BETA) | BIT(GAP) },
    [IS_RATE_AND_STATE] = { .name = "rate-and-state", .model = "rate-and-state", .parts = 3,
        .numbers = rate_and_state,
        .number = { { "normal_force", "N" }, { "reference_friction", "" }, { "reference_velocity", "m/s" },
                    { "direct_effect", "" }, { "evolution_effect", "" }, { "critical_slip_distance", "m" } },
        .confounded = "normal_force with reference_friction", .contains = SIMPLE, .free = BIT(LENGTH) },
};

const driven_law *
ss_driven_law(size_t i)
{
    return i < sizeof list / sizeof *list ? &list[i] : NULL;
}

void
ss_driven_scene(ss_scene *scene, const driven_law *law, const double number[])
{
    scene->model = ss_model_named(law->model);
    if (law->word[0] != NULL)
        ss_scene_set_text(scene, law->word[0], law->word[1], NULL);
    for (size_t i = 0; i < LAW_NUMBERS && law->number[i].name != NULL; i++)
        if (ss_key_named(scene->model, law->number[i].name) != NULL)
            ss_scene_set(scene, law->number[i].name, number[i], NULL);
}
