/* output.c -- the forms of output: streams, HDF5, scripts, and the pictures that gnuplot makes of
 * them. */
#include "options.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/wait.h>
#include <unistd.h>

/* --- by the ending of a name, or by --format ----------------------------------------------- */

static const char *const ending[] = { "h5", "gp", "png", "svg", "pdf", "eps" };

ss_format
tool_stream(tool_kind kind)
{
    return kind == TOOL_H5 ? SS_H5 : (ss_format)(kind - TOOL_STREAM);
}

static int
is_name(char *list, size_t size, const char *name, const char *wanted)
{
    size_t n = strlen(list);
    snprintf(list + n, size - n, " .%s", name);
    return wanted != NULL && strcasecmp(wanted, name) == 0;
}

tool_kind
tool_output_kind(const char *path, unsigned allowed, tool_kind fallback)
{
    char list[256] = "";
    ss_format_info known;
    tool_writes(path);
    if (path == NULL || strcmp(path, "-") == 0 || strcmp(path, "/dev/null") == 0)
        return fallback;
    const char *dot = strrchr(path, '.'), *wanted = dot != NULL ? dot + 1 : NULL;
    for (size_t i = 0; (allowed & TOOL_NUMBERS) && ss_format_at(&known, i); i++)
        if (((allowed & TOOL_NUMBERS) == TOOL_NUMBERS || known.has_words)
            && is_name(list, sizeof list, known.name, wanted))
            return (tool_kind)(TOOL_STREAM + known.format);
    for (int i = TOOL_H5; i < TOOL_STREAM; i++)
        if ((allowed & 1u << i) && is_name(list, sizeof list, ending[i], wanted))
            return (tool_kind)i;
    tool_usage("--output: the ending of '%s' gives the form and must be one of%s", path, list);
}

void
tool_set_format(const tool_option *o, char *text)
{
    enum { MOST = 32 };
    const char *name[MOST + 1] = { NULL };
    ss_format_info known[MOST];
    for (size_t i = 0, n = 0; n < MOST && ss_format_at(&known[n], i); i++)
        if (!(o->range.from > 0) || known[n].has_words) {
            name[n] = known[n].name;
            n++;
        }
    *(tool_kind *)o->to = (tool_kind)(TOOL_STREAM + known[tool_choice("--format", text, name)].format);
}

/* --- files of signals, coefficients and events ------------------------------------------------ */

ss_writer *
tool_writer(const char *path, tool_kind kind, const ss_contents *contents)
{
    ss_writer *writer;
    const char *hdf5 = kind == TOOL_H5 ? tool_output_path(path) : NULL;
    FILE *out = hdf5 == NULL ? tool_output(path) : NULL;
    tool_check(ss_writer_new(&writer, out, hdf5, tool_stream(kind), contents, &tool_error));
    return writer;
}

void
tool_write(const ss_signal *signal, const char *path, tool_kind kind)
{
    const char *hdf5 = kind == TOOL_H5 ? tool_output_path(path) : NULL;
    FILE *out = hdf5 == NULL ? tool_output(path) : NULL;
    tool_check(ss_record_write(&(ss_record){ .signal = signal }, out, hdf5, tool_stream(kind), &tool_error));
}

void
tool_write_rows(ss_writer *writer, double *const column[], size_t n)
{
    tool_check(ss_writer_rows(writer, column, n, &tool_error));
    if (fflush(NULL) != 0)
        tool_check(SS_EIO);
}

void
tool_write_end(ss_writer *writer, size_t samples)
{
    tool_check(ss_writer_end(writer, samples, &tool_error));
    ss_writer_free(writer);
}

/* Replace a header by one whose columns have the names of "OLD=NEW". */
static void
rename_columns(ss_header **head, const char *path, const tool_texts *names)
{
    ss_header *made;
    size_t columns = (*head)->n_columns;
    const char **is = tool_room(NULL, columns, sizeof *is);
    for (size_t c = 0; c < columns; c++)
        is[c] = (*head)->column[c].name;
    for (size_t i = 0; i < names->n; i++) {
        size_t length = strcspn(names->text[i], "=");
        const char *name = names->text[i] + length + 1;
        char *old = strndup(names->text[i], length);
        if (old == NULL)
            tool_die("%s", ss_strerror(SS_ENOMEM));
        if (length == 0 || name[-1] != '=' || *name == '\0')
            tool_usage("--name: '%s' is not OLD=NEW", names->text[i]);
        is[tool_column(*head, path, old)] = name;
        free(old);
    }
    tool_check(ss_header_select(&made, *head, NULL, 0, 0, NULL));
    for (size_t c = 0; c < columns; c++) {
        for (size_t other = 0; other < c; other++)
            if (strcmp(is[c], is[other]) == 0)
                tool_usage("--name: two columns would have the name '%s'", is[c]);
        if ((*head)->has_time && strcmp(is[c], "t") == 0)
            tool_usage("--name: t is the name of the time");
        tool_check(ss_header_add_column(made, is[c], (*head)->column[c].unit, NULL));
    }
    made->has_time = (*head)->has_time;
    ss_header_free(*head);
    *head = made;
    free(is);
}

void
tool_copy(ss_reader *reader, const char *from, const tool_texts *wanted, const tool_texts *names, const char *to,
          tool_kind kind, void (*last)(ss_writer *out))
{
    const ss_header *head = ss_reader_header(reader);
    ss_header *chosen;
    size_t n = wanted->n > 0 ? wanted->n : head->n_columns, rows = 0, got;
    size_t piece = ss_reader_piece(reader);
    size_t *column = tool_room(NULL, n, sizeof *column);
    double **all = tool_columns(head->n_columns, piece), **some = tool_room(NULL, n + 1, sizeof *some);
    for (size_t i = 0; i < n; i++) {
        column[i] = wanted->n > 0 ? tool_column(head, from, wanted->text[i]) : i;
        some[i] = all[column[i]];
    }
    tool_check(ss_header_select(&chosen, head, column, n, 0, NULL));
    if (names->n > 0)
        rename_columns(&chosen, from, names);
    got = tool_rows(reader, all, piece);        /* if this fails, nothing is written */
    ss_writer *out = tool_writer(to, kind, &(ss_contents){ .signal = chosen });
    for (; got > 0; rows += got, got = tool_rows(reader, all, piece))
        tool_write_rows(out, some, got);
    if (last != NULL)
        last(out);
    tool_write_end(out, rows);
    ss_header_free(chosen);
    ss_reader_free(reader);
    free(column);
    free(all);
    free(some);
}

/* --- gnuplot ------------------------------------------------------------------------------- */

/* Start gnuplot on a script, without the settings of a user.  Its messages go to the file `words`, and its
 * picture comes through *picture.  gnuplot runs the commands in GNUTERM, and takes folders, fonts and programs from
 * other variables.  So it gets only the variables that it needs to start and to find the fonts of the machine. */
static pid_t
start_gnuplot(FILE *script, FILE *words, FILE **picture)
{
    extern char **environ;
    static const char *const kept[] = { "PATH", "HOME", "TMPDIR", "LD_LIBRARY_PATH", "FONTCONFIG_PATH",
        "FONTCONFIG_FILE", "XDG_CACHE_HOME", "XDG_CONFIG_HOME", "XDG_DATA_HOME" };
    size_t n = 0;
    int fd[2];
    if (pipe(fd) != 0)
        tool_die("gnuplot cannot be started: %s", strerror(errno));
    pid_t child = fork();
    if (child == 0) {
        dup2(fileno(script), STDIN_FILENO);
        dup2(fd[1], STDOUT_FILENO);
        dup2(fileno(words), STDERR_FILENO);
        close(fd[0]);
        close(fd[1]);
        for (char **entry = environ; *entry != NULL; entry++)
            for (size_t i = 0, length; i < sizeof kept / sizeof *kept; i++)
                if (strncmp(*entry, kept[i], length = strlen(kept[i])) == 0 && (*entry)[length] == '=') {
                    environ[n++] = *entry;
                    break;
                }
        environ[n] = NULL;
        setenv("TZ", "UTC0", 1);        /* for the date in a PDF */
        execlp("gnuplot", "gnuplot", "-d", "-", (char *)NULL);
        _exit(127);
    }
    close(fd[1]);
    *picture = child > 0 ? fdopen(fd[0], "rb") : NULL;
    if (*picture == NULL)
        tool_die("gnuplot cannot be started: %s", strerror(errno));
    return child;
}

/* Replace the time at which Cairo wrote a PDF or EPS, which would make two pictures of one script differ. */
static void
fix_date(char *picture, size_t n)
{
    static const struct { const char *key, *date; } form[] = {
        { "/CreationDate (D:", "20000101000000" }, { "\n%%CreationDate: ", "Sat Jan  1 00:00:00 2000" } };
    for (size_t k = 0; k < sizeof form / sizeof *form; k++) {
        size_t key = strlen(form[k].key), date = strlen(form[k].date);
        for (size_t i = 0; i + key + date <= n; i++)
            if (memcmp(picture + i, form[k].key, key) == 0 && memchr(picture + i + key, '\n', date) == NULL)
                memcpy(picture + i + key, form[k].date, date);
    }
}

/* Run gnuplot and write what it draws, since gnuplot itself does not report a full disk. */
static void
run_gnuplot(FILE *script, FILE *out)
{
    char reason[256] = "gnuplot failed", text[256];
    char *drawn = NULL, piece[BUFSIZ];
    size_t n, got;
    FILE *words = tmpfile(), *picture, *all = open_memstream(&drawn, &n);
    int status;
    if (words == NULL || all == NULL)
        tool_die("gnuplot cannot be started: %s", strerror(errno));
    pid_t child = start_gnuplot(script, words, &picture);
    while ((got = fread(piece, 1, sizeof piece, picture)) > 0)
        fwrite(piece, 1, got, all);
    if (fclose(all) != 0)
        tool_die("%s", ss_strerror(SS_ENOMEM));
    fclose(picture);
    if (waitpid(child, &status, 0) != child)
        tool_die("%s", strerror(errno));
    if (WIFEXITED(status) && WEXITSTATUS(status) == 127)
        tool_die("gnuplot not found; install it, or write a script with -o FILE.gp");
    rewind(words);                  /* the last line is the reason; the lines above it quote the script */
    while (fgets(text, sizeof text, words) != NULL) {
        text[strcspn(text, "\n")] = '\0';
        if (text[strspn(text, " \t^")] != '\0')
            strcpy(reason, text + strspn(text, " \t"));
    }
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0 || n == 0)
        tool_die("%s", reason);
    fclose(words);
    fix_date(drawn, n);
    fwrite(drawn, 1, n, out);       /* tool_end checks for errors */
    free(drawn);
}

void
tool_script_to(const char *path)
{
    if (path == NULL && isatty(STDOUT_FILENO))
        tool_die("a script of many lines is no use on a terminal: draw a picture with -o FILE.png, or open a window "
                 "with | gnuplot -p");
}

static FILE *picture;                   /* where what a script in a temporary file draws goes, or NULL */

FILE *
tool_draw(const char *path, ss_plot_opts *opts)
{
    tool_kind kind = tool_output_kind(path, TOOL_PICTURES, TOOL_GP);
    FILE *out = tool_output(path), *script = kind == TOOL_GP ? out : tmpfile();
    if (script == NULL)
        tool_die("gnuplot cannot be started: %s", strerror(errno));
    picture = kind != TOOL_GP ? out : NULL;
    if (picture != NULL)
        opts->format = ending[kind];
    return script;
}

void
tool_drawn(FILE *script, ss_status status)
{
    if (status == SS_EIO && ferror(script))     /* else a signal could not be read, and the message names its file */
        tool_die("write error: %s", strerror(errno));
    tool_check(status);
    if (picture == NULL)
        return;
    if (fflush(script) != 0 || fseek(script, 0, SEEK_SET) != 0)
        tool_die("write error: %s", strerror(errno));
    run_gnuplot(script, picture);
    fclose(script);
}
