/* prove_events.c -- the events of Coulomb and compliant scenes, proven in ball arithmetic (Arb).
 *
 * Between events the motion is linear, so that each mode is a closed form in balls.  Three steps make
 * a theorem of it:
 *  - No event is missed: from the start of a mode its guard is shown to be positive, piece after piece,
 *    by a Taylor polynomial whose last derivative is a ball, up to one piece in which the guard falls
 *    through zero.
 *  - The time is enclosed by Newton's method for intervals.
 *  - Balls alone would lose some 5 bits an event, since they forget that the errors of time and place
 *    belong together.  The state at a stop, (t, x), is therefore carried as the set c + B e, e in a box
 *    (R. Lohner's method): its image is that of the point c, and to it the derivative of the map from
 *    stop to stop, taken over the whole set, times B e.
 * The event lists of the library are then compared with what is proven.
 *
 * usage: prove_events SECONDS SCENE ...
 *        prove_events random|rigs N
 * A line a scene.  A shipped scene is taken for SECONDS from its initial state, without settling; of the
 * drawn ones (tests/random_scene.h) the first N that are linear, for their whole records: rigs may be
 * pulled, on a belt, damped and of static friction above the kinetic.
 * Exits 1 where the library differs in the kind of an event, or in its time by more than a part 1e-13 of
 * the record (exact) or 1e-12 (rk8pd at that tolerance): 1e-12 and 1e-11 of 10 s.  2 where a proof ends
 * early, as it must where a motion touches what it does not cross: a pull from rest with f_s = f_k. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#ifdef FLINT_HAS_ARB                    /* FLINT 3 and later */
#include <flint/arb.h>
#else
#include <arb.h>
#endif
#include <gsl/gsl_errno.h>
#include "../random_scene.h"
#include "scene/key.h"
#include "scene/scene.h"
#include "../scene_word.h"

/* --- numbers ------------------------------------------------------------------------------------
 * Balls of a pool.  A function that needs room for a moment ends with used = what it was. */

typedef arb_srcptr num;
enum { CHUNK = 4096, CHUNKS = 4096, SCAN_BITS = 96 };
static arb_ptr pool[CHUNKS];
static size_t used;
static slong bits = 192;

static arb_ptr
fresh(void)
{
    size_t chunk = used / CHUNK;
    if (chunk == CHUNKS)
        abort();
    if (pool[chunk] == NULL)
        pool[chunk] = _arb_vec_init(CHUNK);
    return pool[chunk] + used++ % CHUNK;
}

#define BINARY(name, function) \
    static num name(num a, num b) { arb_ptr c = fresh(); function(c, a, b, bits); return c; }
#define UNARY(name, function) \
    static num name(num a) { arb_ptr c = fresh(); function(c, a, bits); return c; }
BINARY(add, arb_add)
BINARY(sub, arb_sub)
BINARY(mul, arb_mul)
BINARY(quotient, arb_div)
UNARY(root, arb_sqrt)
UNARY(exponential, arb_exp)

static num number(double x)         { arb_ptr c = fresh(); arb_set_d(c, x); return c; }
static num minus(num a)             { arb_ptr c = fresh(); arb_neg(c, a); return c; }
static num copy(num a)              { arb_ptr c = fresh(); arb_set(c, a); return c; }
static num scale(int s, num a)      { arb_ptr c = fresh(); arb_mul_si(c, a, s, bits); return c; }
static num middle(num a)            { arb_ptr c = fresh(); arb_get_mid_arb(c, a); return c; }
static double to_double(num a)       { return arf_get_d(arb_midref(a), ARF_RND_NEAR); }
static num hull(num a, num b)       { arb_ptr c = fresh(); arb_union(c, a, b, bits); return c; }

/* --- the rig ----------------------------------------------------------------------------------- */

/* m q'' + c q' + k q = D cos(theta) - f0 + ramp t, theta = W t + phase */
typedef struct linear {
    num c, k, decay, frequency;     /* decay: c / 2 m; frequency: of the free motion, or its growth */
    int oscillates;
    num re, im;                     /* the steady response is re cos(theta) - im sin(theta) */
} linear;

typedef struct rig {
    const ss_scene *scene;
    num m, k, D, W, phase;
    num damping, pull, belt;        /* d, U and S */
    num kinetic, limit;             /* f_k, f_s */
    num contact, damper, deflection;        /* K_y, c, and Y_m = f_k / K_y; 0 for Coulomb */
    linear slip, stop;
} rig;

static linear
linear_of(const rig *r, num c, num k)
{
    linear l = { .c = c, .k = k, .decay = quotient(c, scale(2, r->m)) };
    num square = sub(mul(l.decay, l.decay), quotient(k, r->m));
    l.oscillates = arb_is_negative(square);
    l.frequency = root(l.oscillates ? minus(square) : square);
    num re = sub(k, mul(r->m, mul(r->W, r->W))), im = mul(c, r->W);
    num over = quotient(r->D, add(mul(re, re), mul(im, im)));
    l.re = mul(re, over);
    l.im = minus(mul(im, over));
    return l;
}

static rig
rig_of(const ss_scene *s)
{
    rig r = { .scene = s, .m = number(s->mass), .k = number(s->stiffness), .phase = number(s->phase),
              .damping = number(s->damping), .pull = number(s->base_velocity),
              .belt = number(s->surface_velocity), .kinetic = number(s->friction),
              .limit = number(fmax(s->friction, s->static_friction)) };
    arb_ptr turn = fresh();
    arb_const_pi(turn, bits);
    r.D = mul(r.k, number(s->base_amplitude));
    r.W = mul(scale(2, turn), number(s->base_frequency));
    r.slip = linear_of(&r, r.damping, r.k);
    r.contact = r.damper = r.deflection = number(0);
    if (s->model == ss_model_named("compliant")) {
        r.contact = number(ss_scene_get(s, "contact_stiffness"));
        r.damper = number(ss_scene_get(s, "contact_damping"));
        r.deflection = quotient(r.kinetic, r.contact);
        r.stop = linear_of(&r, add(r.damping, r.damper), add(r.k, r.contact));
    }
    return r;
}

/* --- one mode of the motion -------------------------------------------------------------------- */

/* A number, and its derivatives with respect to (t, x) at the last stop. */
typedef struct vary {
    num value, d[2];
} vary;

typedef struct mode {
    const linear *l;            /* NULL in a Coulomb stick */
    int slip;                   /* its direction; 0 in stick and microstick */
    int side;                   /* in microstick: of the limit at which it began, or 0 */
    int flat;                   /* the first derivatives of its guard, from the 0th, that are 0 at the start */
    vary t, x_ref, q, v, f0;    /* at the start; x = x_ref + q, in microstick + S (t - start) */
    num ramp;
} mode;

typedef struct motion {
    num at[5];                  /* q and its derivatives */
    num free[4];                /* of (q, v) at the end by (q, v) at the start */
} motion;

static void
drive(const rig *r, num t, num *cosine, num *sine)
{
    arb_ptr c = fresh(), s = fresh();
    arb_sin_cos(s, c, add(mul(r->W, t), r->phase), bits);
    *cosine = c;
    *sine = s;
}

static void
free_motion(const rig *r, const linear *l, num u, num out[4])
{
    arb_ptr c = fresh(), s = fresh();
    if (l->oscillates)
        arb_sin_cos(s, c, mul(l->frequency, u), bits);
    else
        arb_sinh_cosh(s, c, mul(l->frequency, u), bits);
    num e = exponential(minus(mul(l->decay, u)));
    num ec = mul(e, c), es = quotient(mul(e, s), l->frequency);
    out[0] = add(ec, mul(l->decay, es));
    out[1] = es;
    out[2] = minus(mul(quotient(l->k, r->m), es));
    out[3] = sub(ec, mul(l->decay, es));
}

static motion
motion_at(const rig *r, const mode *p, num t)
{
    const linear *l = p->l;
    motion o;
    num c, s, c0, s0;
    drive(r, t, &c, &s);
    drive(r, p->t.value, &c0, &s0);
    free_motion(r, l, sub(t, p->t.value), o.free);
    num slope = quotient(p->ramp, l->k);
    num line = minus(quotient(add(p->f0.value, mul(slope, l->c)), l->k));      /* and slope t */
    num q = add(sub(mul(l->re, c), mul(l->im, s)), add(line, mul(slope, t)));
    num v = sub(slope, mul(r->W, add(mul(l->re, s), mul(l->im, c))));
    num q0 = add(sub(mul(l->re, c0), mul(l->im, s0)), add(line, mul(slope, p->t.value)));
    num v0 = sub(slope, mul(r->W, add(mul(l->re, s0), mul(l->im, c0))));
    num free_q = sub(p->q.value, q0), free_v = sub(p->v.value, v0);
    o.at[0] = add(q, add(mul(o.free[0], free_q), mul(o.free[1], free_v)));
    o.at[1] = add(v, add(mul(o.free[2], free_q), mul(o.free[3], free_v)));
    num push[3] = { add(sub(mul(r->D, c), p->f0.value), mul(p->ramp, t)),
                    sub(p->ramp, mul(r->W, mul(r->D, s))),
                    minus(mul(mul(r->W, r->W), mul(r->D, c))) };
    for (int i = 0; i < 3; i++)
        o.at[i + 2] = quotient(sub(push[i], add(mul(l->k, o.at[i]), mul(l->c, o.at[i + 1]))), r->m);
    return o;
}

static num
contact_force(const rig *r, num q, num v)
{
    num force = mul(r->contact, q);
    return strcmp(scene_word(r->scene, "release"), "total") == 0 ? add(force, mul(r->damper, v)) : force;
}

/* What friction has to hold of a mass that moves with the surface, and its first three derivatives. */
static void
load_at(const rig *r, num t, num x, num force[4])
{
    num c, s, W2 = mul(r->W, r->W);
    drive(r, t, &c, &s);
    force[0] = sub(add(mul(r->D, c), mul(r->k, sub(mul(r->pull, t), x))), mul(r->damping, r->belt));
    force[1] = sub(mul(r->k, sub(r->pull, r->belt)), mul(r->W, mul(r->D, s)));
    force[2] = minus(mul(W2, mul(r->D, c)));
    force[3] = mul(W2, mul(r->W, mul(r->D, s)));
}

/* The guard that falls through zero when a mode ends, and its first three derivatives.  In slip there is
 * one, in stick one for each sign of the force. */
static void
guard_at(const rig *r, const mode *p, int sign, num t, num g[4])
{
    num force[4];
    if (p->l == NULL) {
        load_at(r, t, add(p->q.value, mul(r->belt, sub(t, p->t.value))), force);
    } else {
        motion o = motion_at(r, p, t);
        for (int i = 0; i < 4; i++)
            if (p->slip != 0)
                g[i] = scale(p->slip, i == 0 ? sub(o.at[1], r->belt) : o.at[i + 1]);
            else
                force[i] = contact_force(r, o.at[i], o.at[i + 1]);
    }
    for (int i = 0; p->slip == 0 && i < 4; i++)
        g[i] = sub(i == 0 ? r->limit : number(0), scale(sign, force[i]));
}

/* The n-th derivative of a guard, n < 3, over a span of time. */
static num
guard_over(const rig *r, const mode *p, int sign, int n, num span)
{
    num g[4], wide[4], offset = sub(span, middle(span));
    guard_at(r, p, sign, middle(span), g);
    guard_at(r, p, sign, span, wide);
    if (n == 2)
        return add(g[2], mul(wide[3], offset));
    num half = quotient(mul(offset, offset), number(2));
    return add(g[n], add(mul(g[n + 1], offset), mul(wide[n + 2], half)));
}

/* --- the end of a mode, proven ----------------------------------------------------------------- */

typedef enum proof { PROVEN, NO_END, NOT_PROVABLE } proof;

static int
all_positive(const rig *r, const mode *p, num span, int at_start)
{
    int yes = 1;
    size_t mark = used;
    for (int sign = 1; yes && sign >= (p->slip != 0 ? 1 : -1); sign -= 2) {
        int flat = at_start && (p->slip != 0 || sign == p->side) ? p->flat : 0;
        yes = arb_is_positive(guard_over(r, p, sign, flat, span));
    }
    used = mark;
    return yes;
}

/* The sign of the guard that falls through zero once in a span, at whose start all are positive; 0 if
 * that cannot be shown. */
static int
falling(const rig *r, const mode *p, num span, num end)
{
    int found = 0;
    size_t mark = used;
    for (int sign = 1; sign >= (p->slip != 0 ? 1 : -1); sign -= 2) {
        num g[4];
        if (arb_is_positive(guard_over(r, p, sign, 0, span)))
            continue;
        guard_at(r, p, sign, end, g);
        if (found != 0 || !arb_is_negative(g[0]) || !arb_is_negative(guard_over(r, p, sign, 1, span))) {
            found = 0;
            break;
        }
        found = sign;
    }
    used = mark;
    return found;
}

/* A span of time in which exactly one guard falls through zero, once, and before which none does. */
static proof
bracket(const rig *r, const mode *p, double t_end, num *span, int *sign)
{
    double fastest = fmax(to_double(r->W), 1 / t_end);
    if (p->l != NULL)
        fastest = fmax(fastest, to_double(p->l->frequency));
    double from = to_double(p->t.value), longest = .5 / fastest, h = longest;
    size_t mark = used;
    for (int at_start = 1; from < t_end;) {
        used = mark;
        double to = fmin(from + h, t_end);
        num start = at_start ? p->t.value : number(from), end = number(to);
        num piece = hull(start, end);
        if (to == from || h < 1e-12 * longest)
            return NOT_PROVABLE;
        if (all_positive(r, p, piece, at_start)) {
            from = to;
            h = fmin(1.5 * h, longest);
            at_start = 0;
        } else if (!at_start && (*sign = falling(r, p, piece, end)) != 0) {
            *span = piece;
            return PROVEN;
        } else {
            h /= 2;
        }
    }
    return NO_END;
}

/* The zero of a guard that falls through it once in span. */
static num
newton(const rig *r, const mode *p, int sign, num span)
{
    for (;;) {
        num g[4], at = middle(span);
        arb_ptr next = fresh();
        guard_at(r, p, sign, at, g);
        num step = quotient(g[0], guard_over(r, p, sign, 1, span));
        if (!arb_intersection(next, span, sub(at, step), bits))
            abort();                    /* would be a flaw of this program */
        if (arb_contains_zero(g[0]) ||      /* each step before the last one halves it, or better */
                mag_get_d(arb_radref(next)) > .75 * mag_get_d(arb_radref(span)))
            return next;
        span = next;
    }
}

/* --- from one mode to the next ----------------------------------------------------------------- */

static vary
constant(num value)
{
    return (vary){ value, { number(0), number(0) } };
}

static vary
sum(vary a, vary b)
{
    return (vary){ add(a.value, b.value), { add(a.d[0], b.d[0]), add(a.d[1], b.d[1]) } };
}

/* Time, x and v at the end of a mode, which is that zero of its guard which lies in span. */
static void
end_of(const rig *r, const mode *p, int sign, num span, vary *t, vary *x, vary *v)
{
    num T = newton(r, p, sign, span), g[4];
    guard_at(r, p, sign, T, g);
    motion o = { 0 }, start = { 0 };
    num belt = p->slip == 0 ? r->belt : number(0);      /* the frame in which q is measured */
    num along = mul(belt, sub(T, p->t.value));
    if (p->l != NULL) {
        o = motion_at(r, p, T);
        start = motion_at(r, p, p->t.value);
    } else {
        o.at[0] = p->q.value, o.at[1] = o.at[2] = number(0);
    }
    t->value = T;
    x->value = add(add(p->x_ref.value, o.at[0]), along);
    v->value = add(o.at[1], belt);
    for (int i = 0; i < 2; i++) {
        num dq = p->q.d[i], dv = number(0), dg;
        if (p->l == NULL) {
            dg = scale(sign, mul(r->k, sub(dq, mul(r->belt, p->t.d[i]))));
        } else {
            num rest = minus(quotient(p->f0.d[i], p->l->k));
            num dq0 = sub(sub(dq, mul(p->v.value, p->t.d[i])), rest);
            num dv0 = sub(p->v.d[i], mul(start.at[2], p->t.d[i]));
            dq = add(rest, add(mul(o.free[0], dq0), mul(o.free[1], dv0)));
            dv = add(mul(o.free[2], dq0), mul(o.free[3], dv0));
            dg = p->slip != 0 ? scale(p->slip, dv) : scale(-sign, contact_force(r, dq, dv));
        }
        t->d[i] = minus(quotient(dg, g[1]));
        dq = add(dq, mul(o.at[1], t->d[i]));
        x->d[i] = add(add(p->x_ref.d[i], dq), mul(belt, sub(t->d[i], p->t.d[i])));
        v->d[i] = add(dv, mul(o.at[2], t->d[i]));
    }
}

static int
sign_of(num a)      /* 0 if it is not known */
{
    return arb_is_positive(a) ? 1 : arb_is_negative(a) ? -1 : 0;
}

static mode
slip_from(const rig *r, vary t, vary x, vary v, int direction, int flat)
{
    return (mode){ &r->slip, direction, 0, flat, t, constant(number(0)), x, v,
                   constant(scale(direction, r->kinetic)), mul(r->k, r->pull) };
}

/* A microstick whose contact is deflected by Y_m to the side y, or not at all: y'' of the contact. */
static mode
microstick_from(const rig *r, vary t, vary x, int y)
{
    const char *release = scene_word(r->scene, "release");
    int total = release != NULL && strcmp(release, "total") == 0 && ss_scene_get(r->scene, "contact_damping") > 0;
    int at_limit = y != 0 && r->scene->static_friction <= r->scene->friction;
    vary start = constant(scale(y, r->deflection)), x_ref = sum(x, constant(minus(start.value)));
    vary f0 = { add(mul(r->k, sub(x_ref.value, mul(r->belt, t.value))), mul(r->damping, r->belt)), { 0 } };
    for (int i = 0; i < 2; i++)
        f0.d[i] = mul(r->k, sub(x_ref.d[i], mul(r->belt, t.d[i])));
    return (mode){ &r->stop, 0, y, !at_limit ? 0 : total ? 1 : 2, t, x_ref, start, constant(number(0)), f0,
                   mul(r->k, sub(r->pull, r->belt)) };
}

/* What begins where the mass comes to move with the surface; y: the sign of the contact's deflection, or
 * 0.  Returns 0 if that cannot be told. */
static int
stop_from(const rig *r, mode *p, vary t, vary x, int y)
{
    vary zero = constant(number(0)), belt = constant(r->belt);
    num force[4];
    if (r->scene->model == ss_model_named("compliant")) {
        *p = microstick_from(r, t, x, y);
        return 1;
    }
    load_at(r, t.value, x.value, force);
    int direction = sign_of(force[0]);
    if (direction != 0 && arb_is_positive(sub(scale(direction, force[0]), r->limit)))
        *p = slip_from(r, t, x, belt, direction, 1);
    else if (arb_is_negative(sub(force[0], r->limit)) && arb_is_negative(sub(minus(force[0]), r->limit)))
        *p = (mode){ NULL, 0, 0, 0, t, zero, x, zero, zero, NULL };
    else
        return 0;
    return 1;
}

static int
start_of(const rig *r, mode *p)
{
    const ss_scene *s = r->scene;
    vary zero = constant(number(0)), x0 = constant(number(s->x0));
    double v = s->v0 - s->surface_velocity;     /* its sign is right */
    if (v != 0)
        *p = slip_from(r, zero, x0, constant(number(s->v0)), v > 0 ? 1 : -1, 0);
    return v != 0 || stop_from(r, p, zero, x0, 0);
}

/* --- events, of the library and proven --------------------------------------------------------- */

typedef struct listing {
    const char *method;
    ss_event *event;
    size_t n, room;
    double tolerance;           /* of a time [s] */
    double worst;               /* its largest error */
} listing;

typedef struct witness {
    listing list[2];
    size_t n;                   /* events proven */
    const char *problem;        /* the method whose list differs from them, there */
} witness;

static int
keep_event(const ss_event *e, void *user)
{
    listing *l = user;
    if (l->n == l->room) {
        l->room = l->room > 0 ? 2 * l->room : 256;
        l->event = realloc(l->event, l->room * sizeof *l->event);
    }
    l->event[l->n++] = *e;
    return 0;
}

static void
see(witness *w, num t, ss_event_kind kind, int direction)
{
    for (int i = 0; i < 2 && w->problem == NULL; i++) {
        listing *l = &w->list[i];
        size_t mark = used;
        if (w->n >= l->n || l->event[w->n].kind != kind || l->event[w->n].direction != direction) {
            w->problem = l->method;
            return;
        }
        arb_ptr most = fresh();
        arb_get_abs_ubound_arf(arb_midref(most), sub(t, number(l->event[w->n].t)), 53);
        l->worst = fmax(l->worst, arf_get_d(arb_midref(most), ARF_RND_UP));
        if (l->worst > l->tolerance)
            w->problem = l->method;
        used = mark;
    }
    w->n++;
}

/* --- from stop to stop ------------------------------------------------------------------------- */

enum { MOST_MODES = 4 };        /* from a stop to the next: a stick and a slip; at the start one more */

/* The image of a stop: the next one, with its derivatives.  spans[] are found and kept with scan set,
 * else used. */
static proof
leg(const rig *r, mode p, double t_end, int scan, num spans[], int signs[], witness *w, vary *t, vary *x,
    int *direction)
{
    for (int i = 0;; i++) {
        vary v;
        if (scan) {
            slong full = bits;
            bits = SCAN_BITS;
            proof found = bracket(r, &p, t_end, &spans[i], &signs[i]);
            bits = full;
            if (found != PROVEN)
                return found;
        }
        end_of(r, &p, signs[i], spans[i], t, x, &v);
        if (scan)
            spans[i] = copy(t->value);
        *direction = p.slip;
        if (p.slip != 0)
            return PROVEN;
        int way = p.l == NULL ? signs[i] : sign_of(sub(v.value, r->belt));
        if (way == 0)
            return NOT_PROVABLE;
        if (w != NULL)
            see(w, t->value, SS_SLIP, way);
        p = slip_from(r, *t, *x, v, way, p.l != NULL ? 0 : arb_eq(r->limit, r->kinetic) ? 2 : 1);
    }
}

/* The set of states at a stop: c + B e, (t, x) each. */
typedef struct stop_set {
    arb_t c[2], B[2][2], e[2];
    double unit;                /* of x against t, in the choice of B */
} stop_set;

static void
stop_set_init(stop_set *s, double unit)
{
    s->unit = unit;
    for (int i = 0; i < 2; i++) {
        arb_init(s->c[i]);
        arb_init(s->e[i]);
        for (int j = 0; j < 2; j++) {
            arb_init(s->B[i][j]);
            arb_set_si(s->B[i][j], i == j);
        }
    }
}

static void
stop_set_clear(stop_set *s)
{
    for (int i = 0; i < 2; i++) {
        arb_clear(s->c[i]);
        arb_clear(s->e[i]);
        for (int j = 0; j < 2; j++)
            arb_clear(s->B[i][j]);
    }
}

/* The image under a map with these derivatives, of which the point c goes to at.  The new B turns its
 * first axis into the longer side of the image, so that the box stays tight. */
static void
advance(stop_set *s, num at[2], num derivative[2][2])
{
    num M[2][2], inverse[2][2], rest[2], e[2];
    double size[2], turn[2] = { 1, 0 };
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 2; j++)
            M[i][j] = add(mul(derivative[i][0], s->B[0][j]), mul(derivative[i][1], s->B[1][j]));
    for (int j = 0; j < 2; j++)
        size[j] = hypot(to_double(M[0][j]), to_double(M[1][j]) / s->unit) * mag_get_d(arb_radref(s->e[j]));
    int longest = size[1] > size[0];
    double length = hypot(to_double(M[0][longest]), to_double(M[1][longest]) / s->unit);
    if (length > 0) {
        turn[0] = to_double(M[0][longest]) / length;
        turn[1] = to_double(M[1][longest]) / s->unit / length;
    }
    arb_set_d(s->B[0][0], turn[0]);
    arb_set_d(s->B[0][1], -turn[1]);
    arb_set_d(s->B[1][0], turn[1] * s->unit);
    arb_set_d(s->B[1][1], turn[0] * s->unit);
    num det = sub(mul(s->B[0][0], s->B[1][1]), mul(s->B[0][1], s->B[1][0]));
    inverse[0][0] = quotient(s->B[1][1], det);
    inverse[0][1] = minus(quotient(s->B[0][1], det));
    inverse[1][0] = minus(quotient(s->B[1][0], det));
    inverse[1][1] = quotient(s->B[0][0], det);
    for (int i = 0; i < 2; i++) {
        arb_set(s->c[i], middle(at[i]));
        rest[i] = sub(at[i], s->c[i]);
    }
    for (int i = 0; i < 2; i++) {
        e[i] = add(mul(inverse[i][0], rest[0]), mul(inverse[i][1], rest[1]));
        for (int j = 0; j < 2; j++)
            e[i] = add(e[i], mul(add(mul(inverse[i][0], M[0][j]), mul(inverse[i][1], M[1][j])), s->e[j]));
    }
    for (int i = 0; i < 2; i++)
        arb_set(s->e[i], e[i]);
}

static proof
prove(const ss_scene *scene, witness *w, double *until)
{
    double t_end = scene->duration;
    num spans[MOST_MODES];
    int signs[MOST_MODES], y;
    mode p;
    vary t, x;
    stop_set set;
    used = 0;
    rig r = rig_of(scene);
    size_t mark = used;
    if (!start_of(&r, &p))
        return NOT_PROVABLE;
    if (p.slip != 0)
        see(w, number(0), SS_SLIP, p.slip);
    stop_set_init(&set, scene->base_amplitude > 0 ? scene->base_amplitude : 1);
    proof found = leg(&r, p, t_end, 1, spans, signs, w, &t, &x, &y);
    if (found == PROVEN)
        advance(&set, (num[]){ t.value, x.value }, (num[][2]){ { number(0), number(0) }, { number(0), number(0) } });
    while (found == PROVEN && w->problem == NULL) {
        vary image_t, image_x;
        int next;
        used = mark;
        *until = to_double(set.c[0]);
        for (int i = 0; i < 2; i++) {
            num value = add(set.c[i], add(mul(set.B[i][0], set.e[0]), mul(set.B[i][1], set.e[1])));
            *(i == 0 ? &t : &x) = (vary){ value, { number(i == 0), number(i == 1) } };
        }
        if (!stop_from(&r, &p, t, x, y)) {
            found = NOT_PROVABLE;
            break;
        }
        see(w, t.value, p.slip != 0 ? SS_REVERSE : SS_STICK, p.slip != 0 ? p.slip : y);
        found = leg(&r, p, t_end, 1, spans, signs, w, &t, &x, &next);
        if (found != PROVEN)
            break;
        stop_from(&r, &p, constant(set.c[0]), constant(set.c[1]), y);
        leg(&r, p, t_end, 0, spans, signs, NULL, &image_t, &image_x, &next);
        advance(&set, (num[]){ image_t.value, image_x.value },
                (num[][2]){ { t.d[0], t.d[1] }, { x.d[0], x.d[1] } });
        y = next;
    }
    stop_set_clear(&set);
    for (int i = 0; found == NO_END && w->problem == NULL && i < 2; i++)
        if (w->n != w->list[i].n)
            w->problem = w->list[i].method;
    return found;
}

/* --- scenes ------------------------------------------------------------------------------------ */

enum { WRONG = 1, UNFINISHED = 2 };

static void
collect(listing *l, const ss_scene *scene, unsigned long *unresolved)
{
    ss_sim_opts opts;
    ss_sim_opts_init(&opts, sizeof opts);
    ss_sim_stats stats;
    ss_error err;
    opts.method = l->method;
    opts.events = keep_event;
    opts.user = l;
    if (ss_sim_run(scene, &opts, &stats, &err) != SS_OK) {
        fprintf(stderr, "%s: %s\n", l->method, err.text);
        exit(1);
    }
    *unresolved += stats.unresolved;
}

static int
examine(const char *name, const ss_scene *scene)
{
    unsigned long unresolved = 0;
    double until = 0;
    witness w = { .list = { { .method = "exact", .tolerance = 1e-13 * scene->duration },
                            { .method = "rk8pd", .tolerance = 1e-12 * scene->duration } } };
    for (int i = 0; i < 2; i++)
        collect(&w.list[i], scene, &unresolved);
    proof found = prove(scene, &w, &until);
    printf("%s: ", name);
    if (w.problem != NULL)
        printf("%zu events proven; %s differs after %.17g s%s\n", w.n, w.problem, until,
               unresolved > 0 ? ", and says that events are not resolved" : "");
    else if (found == NOT_PROVABLE)
        printf("%zu events proven; not provable from %.17g s of %g on\n", w.n, until, scene->duration);
    else
        printf("%zu events in %g s, proven; largest error exact %.1e, rk8pd %.1e s\n", w.n,
               scene->duration, w.list[0].worst, w.list[1].worst);
    for (int i = 0; i < 2; i++)
        free(w.list[i].event);
    return w.problem != NULL && unresolved == 0 ? WRONG : found == NOT_PROVABLE ? UNFINISHED : 0;
}

static int
examine_shipped(const char *name, double seconds)
{
    ss_scene scene;
    ss_error err;
    if (ss_scene_read(&scene, NULL, name, NULL, 0, &err) != SS_OK) {
        fprintf(stderr, "%s\n", err.text);
        exit(1);
    }
    scene.settle = 0;
    scene.duration = seconds;
    return examine(name, &scene);
}

static int
examine_random(const char *kind, size_t wanted)
{
    int rigs = strcmp(kind, "rigs") == 0;
    int worst = 0;
    for (uint64_t number = 0; wanted > 0; number++) {
        char name[32];
        ss_scene scene = rigs ? random_rig(number) : random_scene(number);
        if (!ss_model_is_linear(scene.model) || scene.friction == 0)
            continue;
        snprintf(name, sizeof name, "%s %llu", kind, (unsigned long long)number);
        worst |= examine(name, &scene);
        wanted--;
    }
    return worst;
}

int
main(int argc, char **argv)
{
    int worst = 0;
    if (argc < 3)
        return 2;
    gsl_set_error_handler_off();
    if (strcmp(argv[1], "random") == 0 || strcmp(argv[1], "rigs") == 0)
        worst = examine_random(argv[1], strtoul(argv[2], NULL, 10));
    else
        for (int i = 2; i < argc; i++)
            worst |= examine_shipped(argv[i], strtod(argv[1], NULL));
    for (size_t i = 0; i < CHUNKS && pool[i] != NULL; i++)
        _arb_vec_clear(pool[i], CHUNK);
    flint_cleanup();
    return worst;
}
