/* signature.c -- recognise an HDF5 file without the HDF5 library. */
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <stickslip/store.h>

int
ss_store_is_hdf5(const char *path)
{
    if (path == NULL)
        return 0;
    static const char signature[8] = "\211HDF\r\n\032\n";
    char bytes[8];
    struct stat st;
    int found = 0;
    if (stat(path, &st) != 0 || !S_ISREG(st.st_mode))   /* a FIFO must not lose its first bytes */
        return 0;
    FILE *in = fopen(path, "rb");
    if (in == NULL)
        return 0;
    for (off_t at = 0; !found && at <= st.st_size - 8; at = at > 0 ? 2 * at : 512)
        found = fseeko(in, at, SEEK_SET) == 0 && fread(bytes, 1, 8, in) == 8
                && memcmp(bytes, signature, 8) == 0;
    fclose(in);
    return found;
}
