/* load.c -- read a scene by its name: a shipped scene, or a file. */
#include <stickslip/scene.h>

#include <errno.h>
#include <string.h>
#include <sys/stat.h>
#include "base/error.h"

static const ss_shipped_scene *const shipped_lists[] = { ss_shipped_scenes, ss_catalogue_scenes };
enum { SHIPPED_LISTS = sizeof shipped_lists / sizeof *shipped_lists };

static const ss_shipped_scene *
find_shipped(const char *name)
{
    for (int i = 0; i < SHIPPED_LISTS; i++)
        for (const ss_shipped_scene *s = shipped_lists[i]; s->name != NULL; s++)
            if (strcmp(s->name, name) == 0)
                return s;
    return NULL;
}

static void
fail_absent(const char *path, ss_error *err)
{
    char names[256] = "";
    for (int i = 0; i < SHIPPED_LISTS; i++)
        for (const ss_shipped_scene *s = shipped_lists[i]; s->name != NULL; s++)
            snprintf(names + strlen(names), sizeof names - strlen(names), "%s%s",
                     *names == '\0' ? "" : ", ", s->name);
    ss_fail(err, SS_EIO, "%s: no such file, and the shipped scenes are %s", path, names);
}

/* The text of a shipped scene, a file, or NULL with the reason in err. */
static FILE *
open_scene(const char *path, ss_error *err)
{
    const ss_shipped_scene *shipped = find_shipped(path);
    if (shipped != NULL) {
        FILE *text = fmemopen((void *)shipped->text, strlen(shipped->text), "r");
        if (text == NULL)
            ss_fail_errno(err, path, errno);
        return text;
    }
    FILE *in = fopen(path, "rb");
    int why = errno;
    struct stat st;
    if (in != NULL && fstat(fileno(in), &st) == 0 && !S_ISDIR(st.st_mode))
        return in;
    if (in != NULL)
        fclose(in);
    if (in != NULL || why != ENOENT)
        ss_fail_errno(err, path, in != NULL ? EISDIR : why);
    else
        fail_absent(path, err);
    return NULL;
}

ss_status
ss_scene_load(ss_scene *scene, const char *path, const char *const settings[], size_t n,
              ss_error *err)
{
    if (scene == NULL || path == NULL || (settings == NULL && n > 0))
        return SS_FAIL_NULL(err);
    FILE *in = open_scene(path, err);
    if (in == NULL)
        return SS_EIO;
    ss_status st = ss_scene_read(scene, in, path, settings, n, err);
    fclose(in);
    return st;
}
