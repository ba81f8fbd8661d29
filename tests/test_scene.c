/* test_scene.c -- scenes: what is read, what is refused and in which words, what is written. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <stickslip.h>

#include "unit.h"
#include "scene/key.h"

static ss_status
read_text(ss_scene *scene, const char *text, const char *const settings[], size_t n,
          ss_error *err)
{
    FILE *in = fmemopen((void *)text, strlen(text), "r");
    assert_non_null(in);
    ss_status st = ss_scene_read(scene, in, "my.scene", settings, n, err);
    fclose(in);
    return st;
}

static const char coulomb[] = "model = coulomb\nmass = 2\nstiffness=50\nfriction=1\n"
    "base_amplitude=.1\nbase_frequency=1\n";

static void
reads_what_is_given_and_defaults_the_rest(void **state)
{
    ss_scene s;
    ss_error err = { 0 };
    (void)state;
    assert_int_equal(read_text(&s, "", NULL, 0, &err), SS_EDATA);
    assert_int_equal(read_text(&s, coulomb, NULL, 0, &err), SS_OK);
    assert_ptr_equal(s.model, ss_model_named("coulomb"));
    assert_true(s.mass == 2 && s.stiffness == 50 && s.friction == 1 && s.base_amplitude == .1);
    assert_true(s.settle == 0 && s.duration == 10 && s.rate == 2000);
    assert_true(s.x0 == 0 && s.v0 == 0 && s.phase == 0);
}

static void
takes_comments_blanks_crlf_and_a_last_line_without_newline(void **state)
{
    ss_scene s;
    ss_error err = { 0 };
    (void)state;
    assert_int_equal(read_text(&s, "\xef\xbb\xbf# a scene\r\n\r\n  model\t=  coulomb # yes\r\nmass=2\r\n"
                               "stiffness = 5e1\r\nfriction = 1\r\nbase_amplitude = 1E-1\r\n"
                               "base_frequency = 1", NULL, 0, &err), SS_OK);
    assert_true(s.stiffness == 50 && s.base_frequency == 1);
}

static void
writes_what_it_reads(void **state)
{
    (void)state;
    for (const ss_shipped_scene *shipped = ss_shipped_scenes; shipped->name; shipped++) {
        ss_scene a, b;
        ss_error err = { 0 };
        char text[2000] = "";
        assert_int_equal(read_text(&a, shipped->text, NULL, 0, &err), SS_OK);
        a.x0 = 0.1 + 0.2;
        FILE *out = fmemopen(text, sizeof text, "w");
        assert_int_equal(ss_scene_write(&a, out, NULL), SS_OK);
        fclose(out);
        assert_int_equal(read_text(&b, text, NULL, 0, &err), SS_OK);
        assert_memory_equal(&a, &b, sizeof a);
        assert_int_equal(ss_scene_samples(&a), 6000);
    }
}

/* A term that is not named is not written; forcing may be left out. */
static void
writes_the_terms_that_are_there(void **state)
{
    static const char rig[] = "model=coulomb\nmass=2\nstiffness=50\nfriction=1\nbase_velocity=-1e-3\n"
        "surface_velocity=0\nstatic_friction=1.5\ndamping=3\n";
    ss_scene a, b;
    char text[2000] = "";
    (void)state;
    assert_int_equal(read_text(&a, rig, NULL, 0, NULL), SS_OK);
    assert_true(a.base_velocity == -1e-3 && a.static_friction == 1.5 && a.damping == 3);
    assert_true(a.base_amplitude == 0 && a.base_frequency == 0);
    FILE *out = fmemopen(text, sizeof text, "w");
    assert_int_equal(ss_scene_write(&a, out, NULL), SS_OK);
    fclose(out);
    assert_null(strstr(text, "surface_velocity"));
    assert_int_equal(read_text(&b, text, NULL, 0, NULL), SS_OK);
    assert_memory_equal(&a, &b, sizeof a);
    a.static_friction = .5;
    assert_int_equal(ss_scene_check(&a, NULL), SS_EINVAL);
}

static void
ships_the_scenes_of_the_figures(void **state)
{
    static const char *const name[] = { "compliant-heavy", "compliant-light", "coulomb",
                                        "state-variable", NULL };
    (void)state;
    for (int i = 0; name[i] != NULL; i++) {
        assert_string_equal(ss_shipped_scenes[i].name, name[i]);
        assert_non_null(strstr(ss_shipped_scenes[i].summary, "Liang & Feeny"));
    }
    assert_null(ss_shipped_scenes[4].name);
}

static void
loads_a_shipped_scene_by_its_name_and_a_file_by_its_path(void **state)
{
    static const char *const setting[] = { "mass = 3" };
    char path[] = "/tmp/stickslip-scene-XXXXXX", wanted[512];
    ss_scene a, b;
    ss_error err = { 0 };
    (void)state;
    for (const ss_shipped_scene *shipped = ss_shipped_scenes; shipped->name; shipped++) {
        assert_int_equal(read_text(&a, shipped->text, setting, 1, &err), SS_OK);
        assert_int_equal(ss_scene_read(&b, NULL, shipped->name, setting, 1, &err), SS_OK);
        assert_memory_equal(&a, &b, sizeof a);
    }
    ss_base *base = (ss_base *)path;            /* none: */
    assert_int_equal(ss_base_load(&base, &b, "coulomb", &err), SS_OK);
    assert_null(base);
    assert_int_equal(ss_scene_read(&b, NULL, "coulomb", (const char *[]){ "c = 1" }, 1, &err), SS_EINVAL);
    assert_memory_equal(&a, &b, sizeof a);

    int fd = mkstemp(path);
    assert_true(fd >= 0 && write(fd, coulomb, sizeof coulomb - 1) == sizeof coulomb - 1);
    close(fd);
    assert_int_equal(read_text(&a, coulomb, NULL, 0, &err), SS_OK);
    assert_int_equal(ss_scene_read(&b, NULL, path, NULL, 0, &err), SS_OK);
    assert_memory_equal(&a, &b, sizeof a);
    unlink(path);
    snprintf(wanted, sizeof wanted, "%s: no such file, and the shipped scenes are compliant-heavy, "
             "compliant-light, coulomb, state-variable, chaos, dahl, den-hartog-stops, den-hartog, free-decay, "
             "leine, lugre, pulled-slider, rate-and-state-lab, rate-and-state-mild, "
             "shaw, subharmonic", path);
    assert_int_equal(ss_scene_read(&b, NULL, path, NULL, 0, &err), SS_EIO);
    assert_string_equal(err.text, wanted);
    assert_int_equal(ss_scene_read(&b, NULL, "/tmp", NULL, 0, &err), SS_EIO);
    assert_string_equal(err.text, "/tmp: Is a directory");
}

#define GOOD "mass=2\nstiffness=50\nfriction=1\nbase_amplitude=.1\nbase_frequency=1\n"

static const struct { const char *text, *setting; ss_status status; const char *says; } bad[] = {
    { "", NULL, SS_EDATA, "my.scene:1: missing key 'model'" },
    { "model = coulomb\nmas = 2\n", NULL, SS_EDATA,
      "my.scene:2: unknown key 'mas'; the nearest is 'mass'" },
    { "contact_stifness = 2\n", NULL, SS_EDATA,
      "my.scene:1: unknown key 'contact_stifness'; the nearest is 'contact_stiffness'" },
    { "model=coulomb\n" GOOD "mass = 3\n", NULL, SS_EDATA,
      "my.scene:7: repeated key 'mass', first given on line 2" },
    { "model=coulomb\n" GOOD "alpha = 3\n", NULL, SS_EDATA,
      "my.scene:7: model coulomb has no key 'alpha'" },
    { "model=compliant\n" GOOD "contact_stiffness = 3\n", NULL, SS_EDATA,
      "my.scene:8: missing key 'contact_damping', which model compliant needs" },
    { "model=sliding\n", NULL, SS_EDATA, "my.scene:1: model is 'sliding', but must be one of "
      "coulomb, state-variable, compliant, stribeck, lugre, bouc-wen, "
      "rate-and-state" },
    { "model=coulomb\n" GOOD "static_friction = .5\n", NULL, SS_EDATA, "my.scene:7: static_friction is less "
      "than friction, it must be at least as large" },
    { "model=coulomb\nstatic_friction=2\n" GOOD, "friction=3", SS_EINVAL, "static_friction is less than "
      "friction, it must be at least as large" },
    { "model=state-variable\nalpha=1\ngamma=1\n" GOOD "static_friction = 2\n", NULL, SS_EDATA,
      "my.scene:9: model state-variable has no key 'static_friction'" },
    { "model=coulomb\n" GOOD "damping = -1\n", NULL, SS_EDATA,
      "my.scene:7: damping = -1 is out of range, it must be >= 0" },
    { "model=coulomb\nmass=2\nstiffness=50\nfriction=1\nbase_frequency=1\n", NULL, SS_EDATA,
      "my.scene:6: missing key 'base_amplitude': the base moves by it" },
    { "model=coulomb\n" GOOD "base_file = z.tsv\n", NULL, SS_EDATA, "my.scene:7: base_file and base_amplitude "
      "exclude each other: the base moves by one of them" },
    { "model=coulomb\n" GOOD "base_column = z\n", NULL, SS_EDATA,
      "my.scene:7: base_column is one of base_file, which is missing" },
    { "base_file = ../z.tsv\n", NULL, SS_EDATA,
      "my.scene:1: base_file leads out of the scene's folder; a file there or below is meant" },
    { "base_file = a/../../z.tsv\n", NULL, SS_EDATA,
      "my.scene:1: base_file leads out of the scene's folder; a file there or below is meant" },
    { "base_file = /etc/passwd\n", NULL, SS_EDATA,
      "my.scene:1: base_file leads out of the scene's folder; a file there or below is meant" },
    { "base_file = z\033[2J.tsv\n", NULL, SS_EDATA, "my.scene:1: base_file has a control character or a '#'" },
    { "base_file = \302\233.tsv\n", NULL, SS_EDATA, "my.scene:1: base_file has a control character or a '#'" },
    { "model=coulomb\n" GOOD, "base_file=z\nmass=1", SS_EINVAL, "base_file has a control character or a '#'" },
    { "model=coulomb\n" GOOD, "base_file=z#.tsv", SS_EINVAL, "base_file has a control character or a '#'" },
    { "base_column =\n", NULL, SS_EDATA, "my.scene:1: base_column is empty" },
    { "mass = -2", NULL, SS_EDATA, "my.scene:1: mass = -2 is out of range, it must be > 0" },
    { "friction = -1e-300", NULL, SS_EDATA,
      "my.scene:1: friction = -1e-300 is out of range, it must be >= 0" },
    { "mass = 0", NULL, SS_EDATA, "my.scene:1: mass = 0 is out of range, it must be > 0" },
    { "mass = 1e999", NULL, SS_EDATA, "my.scene:1: mass = 1e999 is out of range, it must be > 0" },
    { "x0 = nan", NULL, SS_EDATA, "my.scene:1: x0 is 'nan', but must be a number" },
    { "x0 = 0x10", NULL, SS_EDATA, "my.scene:1: x0 is '0x10', but must be a number" },
    { "x0 = 1,5", NULL, SS_EDATA, "my.scene:1: x0 is '1,5', but must be a number" },
    { "x0 =", NULL, SS_EDATA, "my.scene:1: x0 is '', but must be a number" },
    { "\n\nhello\n", NULL, SS_EDATA, "my.scene:3: expected 'key = value', found 'hello'" },
    { "model=coulomb\n" GOOD, "mas=2", SS_EINVAL, "unknown key 'mas'; the nearest is 'mass'" },
    { "model=coulomb\n" GOOD, "mass=-2", SS_EINVAL, "mass = -2 is out of range, it must be > 0" },
    { "model=coulomb\n" GOOD, "alpha=2", SS_EINVAL, "model coulomb has no key 'alpha'" },
    { "model=coulomb\n" GOOD, "mass", SS_EINVAL, "expected 'key = value', found 'mass'" },
};

static void
says_what_is_wrong_and_where(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        ss_scene s, before;
        ss_error err = { 0 };
        memset(&s, 7, sizeof s);
        before = s;
        assert_int_equal(read_text(&s, bad[i].text, &bad[i].setting, bad[i].setting != NULL,
                                   &err), bad[i].status);
        assert_string_equal(err.text, bad[i].says);
        assert_memory_equal(&s, &before, sizeof s);     /* unchanged on failure */
    }
}

static void
settings_take_the_place_of_lines(void **state)
{
    static const char *const set[] = { "mass = 3", "rate=20" }, *const twice[] = { "rate=1",
                                                                                  "rate=2" };
    ss_scene s;
    ss_error err = { 0 };
    (void)state;
    assert_int_equal(read_text(&s, coulomb, set, 2, &err), SS_OK);
    assert_true(s.mass == 3 && s.rate == 20);
    assert_int_equal(read_text(&s, coulomb, twice, 2, &err), SS_EINVAL);
    assert_string_equal(err.text, "repeated key 'rate'");
}

static void
checks_scenes_made_by_hand(void **state)
{
    ss_scene s = ss_scene_defaults;
    ss_error err = { 0 };
    (void)state;
    assert_int_equal(ss_scene_check(&s, &err), SS_EINVAL);
    assert_string_equal(err.text, "the scene has no model");
    assert_int_equal(ss_scene_set_text(&s, "model", "coulomb", &err), SS_OK);
    assert_int_equal(ss_scene_check(&s, &err), SS_EINVAL);
    assert_string_equal(err.text, "mass = 0 is out of range, it must be > 0");
    s.mass = s.stiffness = 1;
    assert_int_equal(ss_scene_set(&s, "alpha", 1, &err), SS_EINVAL);
    assert_string_equal(err.text, "model coulomb has no key 'alpha'");
    assert_int_equal(ss_scene_check(&s, &err), SS_OK);
    strcpy(s.base_file, "z\nmass = 2");
    assert_int_equal(ss_scene_check(&s, &err), SS_EINVAL);
    assert_string_equal(err.text, "base_file has a control character or a '#'");
    s.base_file[0] = '\0';
    s.model = NULL;
    assert_int_equal(ss_scene_check(&s, &err), SS_EINVAL);
    ss_scene_set_text(&s, "model", "state-variable", NULL);
    assert_int_equal(ss_scene_check(&s, NULL), SS_EINVAL);
}

/* What the tables say, against what scenes do. */
static void
models_do_what_their_tables_say(void **state)
{
    static const struct { const char *name, *shipped; } row[] = {
        { "coulomb", "coulomb" }, { "state-variable", "state-variable" }, { "compliant", "compliant-heavy" },
    };
    (void)state;
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        ss_scene s;
        ss_sim_opts opts;
        ss_sim_opts_init(&opts, sizeof opts);
        ss_sim_stats stats;
        assert_int_equal(ss_scene_read(&s, NULL, row[i].shipped, NULL, 0, NULL), SS_OK);
        assert_ptr_equal(s.model, ss_model_named(row[i].name));
        assert_string_equal(ss_model_name(s.model), row[i].name);
        opts.method = "rk8pd";
        assert_int_equal(ss_sim_run(&s, &opts, &stats, NULL), SS_OK);
        assert_int_equal(ss_model_has_events(s.model), stats.events > 0);
        opts.method = "exact";
        assert_int_equal(ss_model_is_linear(s.model), ss_sim_run(&s, &opts, NULL, NULL) == SS_OK);
    }
}

static void
refuses_bytes_that_are_not_text(void **state)
{
    static const char nul[] = "model = coulomb\nmass = 2\0\n";
    char *longest = malloc(5000);
    ss_scene s;
    ss_error err = { 0 };
    (void)state;
    FILE *in = fmemopen((void *)nul, sizeof nul - 1, "r");
    assert_int_equal(ss_scene_read(&s, in, "my.scene", NULL, 0, &err), SS_EDATA);
    assert_string_equal(err.text, "my.scene:2: NUL byte: this is not a text file");
    fclose(in);
    memset(longest, 'm', 4999);
    longest[4999] = '\0';
    assert_int_equal(read_text(&s, longest, NULL, 0, &err), SS_EDATA);
    assert_string_equal(err.text, "my.scene:1: line too long");
    free(longest);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(reads_what_is_given_and_defaults_the_rest),
        cmocka_unit_test(takes_comments_blanks_crlf_and_a_last_line_without_newline),
        cmocka_unit_test(writes_what_it_reads),
        cmocka_unit_test(writes_the_terms_that_are_there),
        cmocka_unit_test(ships_the_scenes_of_the_figures),
        cmocka_unit_test(loads_a_shipped_scene_by_its_name_and_a_file_by_its_path),
        cmocka_unit_test(says_what_is_wrong_and_where),
        cmocka_unit_test(settings_take_the_place_of_lines),
        cmocka_unit_test(checks_scenes_made_by_hand),
        cmocka_unit_test(models_do_what_their_tables_say),
        cmocka_unit_test(refuses_bytes_that_are_not_text),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
