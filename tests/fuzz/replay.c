/* replay.c -- run a harness over the files named, without libFuzzer. */
#include "fuzz.h"

#include <stdlib.h>

static void
replay(const char *path)
{
    FILE *in = fopen(path, "rb");
    fuzz_check(in != NULL && fseek(in, 0, SEEK_END) == 0, path);
    size_t size = (size_t)ftell(in);
    uint8_t *bytes = malloc(size + 1);
    rewind(in);
    fuzz_check(bytes != NULL && fread(bytes, 1, size, in) == size, path);
    fclose(in);
    fprintf(stderr, "%s\n", path);      /* the last one named is the one that fails */
    LLVMFuzzerTestOneInput(bytes, size);
    free(bytes);
}

int
main(int argc, char *argv[])
{
    for (int i = 1; i < argc; i++)
        replay(argv[i]);
    return 0;
}
