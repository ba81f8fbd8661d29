/* kind.c -- the kind of a file that was not expected, by its first bytes. */
#include <string.h>
#include "base/error.h"

#define PICTURE "a picture", "give what it was drawn from"
#define NETCDF "a netCDF 3 file", "nccopy -k nc4 makes HDF5 of it"
#define UTF16 "text in UTF-16", "iconv -f UTF-16 -t UTF-8 converts it"
#define SOUND "a sound file", "sox FILE -t au - makes a signal of it"

static const struct kind {
    const char *magic, *what;
    const char *remedy;         /* with other programs; may be NULL */
} kinds[] = {
    { "# stickslip signal ", "a signal", NULL },
    { "# stickslip coefficients ", "wavelet coefficients", NULL },
    { "# stickslip features ", "a list of features", NULL },
    { "# stickslip events ", "a list of events", NULL },
    { "# stickslip sweep ", "a sweep", NULL },
    { "# stickslip ranking ", "a ranking", NULL },
    { "# stickslip trade ", "a trade of accuracy for time", NULL },
    { "# Made by libstickslip ", "a gnuplot script", "gnuplot -p FILE shows it" },
    { ".snd", "a Sun AU stream", NULL },
    { "\211HDF", "an HDF5 file", NULL },
    { "\211PNG", PICTURE }, { "%PDF-", PICTURE }, { "<?xml", PICTURE }, { "<svg", PICTURE },
    { "\377\330\377", PICTURE },
    { "RIFF", SOUND }, { "fLaC", SOUND }, { "OggS", SOUND },
    { "ID3\003", SOUND }, { "ID3\004", SOUND },
    { "\037\213", "a gzip file", "gunzip unpacks it" },
    { "\377\376", UTF16 }, { "\376\377", UTF16 },
    { "PK\003\004", "a workbook or another zip archive", "save its sheet as CSV" },
    { "\320\317\021\340", "a workbook", "save its sheet as CSV" },
    { "MATLAB 5.0 MAT-file", "a MATLAB file older than v7.3",
      "in MATLAB, save('FILE', '-v7.3') writes one that can be read" },
    { "TDSm", "a LabVIEW TDMS file", "export it as text" },
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

/* No line of a scene has a separator of columns before its "=" or comment. */
static int
is_table(const char *p, const char *end)
{
    for (; p < end && *p != '#' && *p != '=' && *p != '\n'; p++)
        if (*p == ',' || *p == ';' || *p == '\t')
            return 1;
    return 0;
}

ss_status
ss_fail_kind(ss_error *err, const char *name, const char *bytes, size_t n, const char *wanted)
{
    static const struct kind scene = { "", "a scene", NULL };
    static const struct kind table = { "", "a table of numbers or names", NULL };
    const struct kind *found = is_scene(bytes, bytes + n) ? &scene
        : strcmp(wanted, "a scene") == 0 && is_table(bytes, bytes + n) ? &table : NULL;
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        size_t length = strlen(kinds[i].magic);
        if (n >= length && memcmp(bytes, kinds[i].magic, length) == 0)
            found = &kinds[i];
    }
    if (found == NULL || strcmp(found->what, wanted) == 0)
        return SS_OK;
    return ss_fail(err, SS_EKIND, "%s: %s, not %s%s%s", name, found->what, wanted,
                   found->remedy != NULL ? "; " : "", found->remedy != NULL ? found->remedy : "");
}
