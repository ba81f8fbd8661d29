/* fuzz_scene.c -- scenes, and the settings of --set: all behind a first NUL. */
#include "fuzz.h"

#include <stdlib.h>
#include <string.h>

static void
check_scene(const ss_scene *scene)
{
    size_t length = 0;
    char *text = NULL;
    ss_scene back;
    ss_error err = { 0 };
    fuzz_check(ss_scene_check(scene, &err) == SS_OK, err.text);
    FILE *out = open_memstream(&text, &length);
    fuzz_check(ss_scene_write(scene, out, NULL) == SS_OK, "written");
    fclose(out);
    FILE *in = fuzz_open(text, length);
    fuzz_check(ss_scene_read(&back, in, "in", NULL, 0, &err) == SS_OK, err.text);
    fclose(in);
    free(text);
    fuzz_check(memcmp(&back, scene, sizeof back) == 0, "the scene reads back");
}

int
LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    ss_scene scene;
    ss_error err = { 0 };
    const uint8_t *nul = size > 0 ? memchr(bytes, 0, size) : NULL;
    size_t text = nul != NULL ? (size_t)(nul - bytes) : size, rest = size - text;
    char *setting = calloc(rest + 1, 1);
    fuzz_check(setting != NULL, "memory for a setting");
    if (rest > 0)
        memcpy(setting, nul + 1, rest - 1);
    const char *const settings[] = { setting };
    FILE *in = fuzz_open(bytes, text);
    memset(&scene, 0, sizeof scene);
    ss_status status = ss_scene_read(&scene, in, "in", settings, nul != NULL, &err);
    if (status == SS_OK)
        check_scene(&scene);
    else
        fuzz_check_refusal(status == SS_EINVAL && nul != NULL ? SS_EDATA : status, &err);
    fclose(in);
    free(setting);
    return 0;
}
