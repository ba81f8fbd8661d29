/* input.c -- open and read what the command line names, or die. */
#include "common.h"

#include <errno.h>
#include <limits.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

const char *
tool_input(int argc, char *argv[], int first)
{
    if (argc - first > 1)
        tool_usage("unexpected argument '%s'; -o FILE names the output", argv[first + 1]);
    const char *path = "-";
    if (argc > first)
        path = argv[first];
    return tool_reads(path);
}

const char *
tool_input_name(const char *path)
{
    return strcmp(path, "-") == 0 ? "<stdin>" : path;
}

const char *
tool_file_name(const char *path)
{
    const char *slash = strstr(path, ":/") == NULL ? strrchr(path, '/') : NULL;
    return slash != NULL && slash[1] != '\0' ? slash + 1 : tool_input_name(path);
}

/* 1 if a path that is read now stands for standard input. */
static int
is_stdin(const char *path)
{
    static int used;
    if (strcmp(tool_reads(path), "-") != 0)
        return 0;
    if (used)
        tool_usage("standard input can be read only once");
    return used = 1;
}

void
tool_one_stdin(const char *const path[], size_t n)
{
    for (size_t i = 0, standard = 0; i < n; i++)
        if (path[i] != NULL && strcmp(path[i], "-") == 0 && standard++ > 0)
            tool_usage("standard input can be read only once");
}

FILE *
tool_open(const char *path)
{
    if (is_stdin(path))
        return stdin;
    FILE *in = fopen(path, "rb");
    struct stat st;
    if (in != NULL && fstat(fileno(in), &st) == 0 && S_ISDIR(st.st_mode)) {
        fclose(in);
        in = NULL;
        errno = EISDIR;
    }
    if (in == NULL)
        tool_die("%s: %s", path, strerror(errno));
    return in;
}

ss_reader *
tool_read_rows(const char *path, const ss_read_opts *opts)
{
    ss_reader *reader = NULL;
    FILE *in = is_stdin(path) ? stdin : NULL;
    struct stat st;
    if (in == NULL && stat(path, &st) == 0 && S_ISFIFO(st.st_mode))
        in = freopen(path, "rb", stdin);        /* which ends when the user stops */
    tool_check(ss_reader_new(&reader, in, tool_input_name(path), opts, &tool_error));
    return reader;
}

double **
tool_columns(size_t n, size_t rows)
{
    double **column = tool_room(NULL, n + 1, sizeof *column + rows * sizeof **column);
    for (size_t c = 0; c < n; c++)
        column[c] = (double *)(column + n) + c * rows;
    return column;
}

size_t
tool_rows(ss_reader *reader, double *const column[], size_t max)
{
    static ss_status st;
    size_t n = 0;
    if (st == SS_OK)
        st = ss_reader_rows(reader, column, max, &n, &tool_error);
    if (tool_stopping())                /* the last row may be a part of one */
        return 0;
    if (n == 0)
        tool_check(st);
    return n;
}

ss_signal *
tool_read_signal(const char *path, const ss_read_opts *opts)
{
    ss_signal *signal = NULL;
    FILE *in = is_stdin(path) ? stdin : NULL;
    tool_check(ss_signal_read(&signal, in, tool_input_name(path), opts, &tool_error));
    if (opts != NULL && opts->progress.function != NULL)
        tool_reading_done();
    return signal;
}

ss_overlay *
tool_read_overlay(const char *path, ss_kind kind)
{
    ss_overlay *overlay;
    if (path == NULL)
        return NULL;
    FILE *in = tool_open(path);
    tool_check(ss_overlay_read(&overlay, in, tool_input_name(path), kind, &tool_error));
    if (in != stdin)
        fclose(in);
    return overlay;
}

ss_coefficients *
tool_read_coefficients(const char *path)
{
    ss_coefficients *coefficients = NULL;
    FILE *in = is_stdin(path) ? stdin : NULL;
    tool_check(ss_coefficients_read(&coefficients, in, tool_input_name(path), &tool_error));
    return coefficients;
}

void
tool_check_base(ss_status status)
{
    const char *hint = tool_hint(status, &tool_error);
    if (strncmp(hint, "; --", 4) == 0)
        tool_die("%s; a base is read as it is, and ss-cat writes it anew: %s", tool_error.text, hint + 2);
    tool_check(status);
}

/* The name of the scene's base is relative to the scene's folder. */
ss_scene
tool_read_scene(const char *path, const tool_texts *settings, const char *options)
{
    static ss_base *base;               /* the scene points at it */
    const char *slash = strrchr(path, '/');
    char name[PATH_MAX + SS_BASE_FILE];
    ss_scene scene;
    ss_status st = ss_scene_read(&scene, is_stdin(path) ? stdin : NULL, tool_input_name(path), settings->text,
                                 settings->n, &tool_error);
    if (st == SS_EINVAL)
        tool_usage("%s: %s", options, tool_error.text);
    tool_check(st);
    snprintf(name, sizeof name, "%.*s%s", slash != NULL ? (int)(slash - path) + 1 : 0, path, scene.base_file);
    if (scene.base_file[0] != '\0')
        tool_reads(name);
    tool_check_base(ss_base_load(&base, &scene, strcmp(path, "-") == 0 ? "" : path, &tool_error));
    return scene;
}

char *
tool_name_scene(const char *path, const tool_texts *settings)
{
    static const char *const of_record[] = { "settle", "duration", "rate" };
    size_t size = strlen(tool_file_name(path)) + 1;
    for (size_t i = 0; settings != NULL && i < settings->n; i++)
        size += strlen(settings->text[i]) + 2;
    char *name = tool_room(NULL, size, 1), *end = stpcpy(name, tool_file_name(path));
    for (size_t i = 0; settings != NULL && i < settings->n; i++) {
        int physical = 1;
        for (size_t k = 0; k < sizeof of_record / sizeof *of_record; k++)
            physical &= strncmp(settings->text[i], of_record[k], strlen(of_record[k])) != 0;
        if (physical)
            end = stpcpy(stpcpy(end, ", "), settings->text[i]);
    }
    return ss_printable(name);
}

void
tool_list(char *list, size_t size, const char *word)
{
    size_t length = strlen(list);               /* invariant: there is room for the dots */
    if (length >= 3 && strcmp(list + length - 3, "...") == 0)
        return;
    if (length + strlen(word) + sizeof ",  ..." > size)
        strcpy(list + length, " ...");
    else
        stpcpy(stpcpy(list + length, length > 0 ? ", " : ""), word);
}

size_t
tool_column(const ss_header *head, const char *path, const char *name)
{
    const char *const usual[] = { ss_header_find_note(head, "column"), "a" };
    int c = name != NULL ? ss_header_column(head, name) : -1;
    for (int i = 0; name == NULL && c < 0 && i < 2; i++)
        c = usual[i] != NULL ? ss_header_column(head, usual[i]) : -1;
    if (c < 0 && name == NULL && head->n_columns == 1)
        c = 0;
    if (c >= 0)
        return (size_t)c;
    char list[512] = "";
    for (size_t i = 0; i < head->n_columns; i++)
        tool_list(list, sizeof list, head->column[i].name);
    if (name == NULL)
        tool_die("%s: choose a column with --column from %s", tool_input_name(path), list);
    tool_die("%s: no column '%s', there are %s", tool_input_name(path), name, list);
}
