/* kind.c -- recognise the kind of a file by its first bytes. */
#include <string.h>
#include "base/error.h"

static const struct {
    const char *what, *magic;
} kinds[] = {
    [SS_KIND_SIGNAL] = { "a signal", "# stickslip signal 1" },
    [SS_KIND_COEFFICIENTS] = { "wavelet coefficients", "# stickslip coefficients 1" },
    [SS_KIND_FEATURES] = { "a list of features", "# stickslip features 1" },
    [SS_KIND_EVENTS] = { "a list of events", "# stickslip events 1" },
    [SS_KIND_SWEEP] = { "a sweep", "# stickslip sweep 1" },
    [SS_KIND_RANKING] = { "a ranking", "# stickslip ranking 1" },
    [SS_KIND_TRADE] = { "a trade of accuracy for time", "# stickslip trade 1" },
    [SS_KIND_SPECTRUM] = { "a spectrum", "# stickslip spectrum 1" },
    [SS_KIND_BACKBONE] = { "a backbone", "# stickslip backbone 1" },
    [SS_KIND_RIDGE] = { "a ridge", "# stickslip ridge 1" },
    [SS_KIND_SUMMARIES] = { "a table of summaries", "# stickslip summaries 1" },
    [SS_KIND_SCENE] = { "a scene", NULL },
    [SS_KIND_TABLE] = { "a table of numbers or names", NULL },
    [SS_KIND_AU] = { "a Sun AU stream", ".snd" },
    [SS_KIND_HDF5] = { "an HDF5 file", "\211HDF" },
};
enum { KINDS = sizeof kinds / sizeof *kinds };

#define PICTURE "a picture", "; give what it was drawn from"
#define NETCDF "a netCDF 3 file", "; nccopy -k nc4 makes HDF5 of it"
#define UTF16 "text in UTF-16", "; iconv -f UTF-16 -t UTF-8 converts it"
#define UNPACKED(by) "; read what " by " -c FILE gives"
#define SOUND "a sound file", "; sox FILE -t au - makes a signal of it"
#define PANDAS(form) "; in Python, pandas.read_" form "('FILE').to_csv('run.csv', index=False)"
#define JSON "a JSON file", PANDAS("json")
#define PICKLE "a pickle of Python", "; in Python, numpy.save or to_csv of what it holds writes a readable file"

/* Files of other programs, and a way to make a readable file of them. */
static const struct foreign {
    const char *magic, *what, *remedy;
} foreign[] = {
    { "# Made by libstickslip ", "a gnuplot script", "; gnuplot -p FILE shows it" },
    { "\211PNG", PICTURE }, { "%PDF-", PICTURE }, { "<?xml", PICTURE }, { "<svg", PICTURE },
    { "\377\330\377", PICTURE },
    { "RIFF", SOUND }, { "fLaC", SOUND }, { "OggS", SOUND },
    { "ID3\003", SOUND }, { "ID3\004", SOUND }, { "FORM", SOUND },
    { "PAR1", "a Parquet file", PANDAS("parquet") }, { "ARROW1", "a Feather file", PANDAS("feather") },
    { "FEA1", "a Feather file", PANDAS("feather") },
    { "{\"", JSON }, { "{\n", JSON }, { "{\r", JSON }, { "{ ", JSON }, { "[{", JSON }, { "[[", JSON },
    { "\200\002", PICKLE }, { "\200\003", PICKLE }, { "\200\004", PICKLE }, { "\200\005", PICKLE },
    { "\037\213", "a gzip file", UNPACKED("gunzip") }, { "BZh", "a bzip2 file", UNPACKED("bunzip2") },
    { "\3757zXZ", "an xz file", UNPACKED("unxz") }, { "\050\265\057\375", "a Zstandard file", UNPACKED("unzstd") },
    { "\377\376", UTF16 }, { "\376\377", UTF16 },
    { "PK\003\004", "a workbook or another zip archive", "; save its sheet as CSV, or an array of it by numpy.save" },
    { "\320\317\021\340", "a workbook", "; save its sheet as CSV" },
    { "MATLAB 5.0 MAT-file", "a MATLAB file older than v7.3",
      "; in MATLAB, save('FILE', 'x', '-v7.3') writes HDF5; in Python, "
      "numpy.save('x.npy', scipy.io.loadmat('FILE')['x'])" },
    { "TDSm", "a LabVIEW TDMS file", "; in Python, nptdms.TdmsFile.read('FILE').as_dataframe(time_index=True)"
      ".to_csv('run.csv', index_label='t_s')" },
    { "CDF\001", NETCDF }, { "CDF\002", NETCDF },
};

/* Most scenes begin with their model, after comments. */
static int
is_scene(const char *p, const char *end)
{
    static const char model[] = "model";
    while (p < end && (*p == '#' || *p == '\n' || *p == '\r')) {
        const char *newline = memchr(p, '\n', (size_t)(end - p));
        p = newline != NULL ? newline + 1 : end;
    }
    while (p < end && (*p == ' ' || *p == '\t'))
        p++;
    if ((size_t)(end - p) < sizeof model || memcmp(p, model, sizeof model - 1) != 0)
        return 0;
    for (p += sizeof model - 1; p < end && (*p == ' ' || *p == '\t'); p++)
        ;
    return p < end && *p == '=';
}

const char *
ss_kind_magic(ss_kind kind)
{
    return (unsigned)kind < KINDS ? kinds[kind].magic : NULL;
}

ss_status
ss_fail_kind(ss_error *err, const char *name, const char *bytes, size_t n, ss_kind wanted)
{
    /* a table has a separator of columns in its first line; a scene has none before its "=" or comment */
    size_t i = 0;
    while (i < n && memchr("#=\n,;\t", bytes[i], 6) == NULL)
        i++;
    const int is_table = i < n && memchr(",;\t", bytes[i], 3) != NULL;
    ss_kind found = is_scene(bytes, bytes + n) ? SS_KIND_SCENE
        : wanted == SS_KIND_SCENE && is_table ? SS_KIND_TABLE : SS_KIND_UNKNOWN;
    const char *what = kinds[found].what, *remedy = "";
    for (int k = 0; k < KINDS; k++) {   /* another version of this library wrote the same kind: that is not compared */
        const char *magic = kinds[k].magic;
        const size_t length = magic != NULL ? strlen(magic) - (magic[0] == '#') : n + 1;
        if (length <= n && memcmp(bytes, magic, length) == 0) {
            found = (ss_kind)k;
            what = kinds[k].what;
        }
    }
    for (i = 0; what == NULL && i < sizeof foreign / sizeof *foreign; i++)
        if (n >= strlen(foreign[i].magic) && memcmp(bytes, foreign[i].magic, strlen(foreign[i].magic)) == 0) {
            what = foreign[i].what;
            remedy = foreign[i].remedy;
        }
    if (what == NULL || found == wanted)
        return SS_OK;
    ss_fail(err, SS_EKIND, "%s: %s, not %s%s", name, what, kinds[wanted].what, remedy);
    if (err != NULL && found != SS_KIND_UNKNOWN)
        err->found = found;
    return SS_EKIND;
}

ss_status
ss_fail_magic(ss_error *err, const char *name, const char *line, ss_kind wanted)
{
    if (line == NULL)
        return ss_fail(err, SS_EDATA, "%s: empty", name);
    if (ss_fail_kind(err, name, line, strlen(line), wanted) != SS_OK)
        return SS_EKIND;
    return ss_fail_wanted(ss_fail(err, SS_EKIND, "%s:1: not %s, of which the first line is '%s'", name,
                                  kinds[wanted].what, kinds[wanted].magic), wanted, err);
}

ss_status
ss_fail_wanted(ss_status status, ss_kind wanted, ss_error *err)
{
    if (err != NULL)
        err->wanted = wanted;
    return status;
}
