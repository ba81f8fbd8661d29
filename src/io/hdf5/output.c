/* output.c -- the file that HDF5 writes, whole or absent.
 *
 * The same input gives the same bytes: nothing in the file depends on the clock, the path or the
 * machine.  If HDF5 cannot seek in the output, it writes a file without a name, which is then
 * copied. */
#include "io/hdf5/output.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include "base/error.h"
#include "io/hdf5/h5_write.h"

static hid_t
create_file(const char *path, hid_t access)
{
    hid_t how = H5Pcreate(H5P_FILE_CREATE);
    H5Pset_fclose_degree(access, H5F_CLOSE_STRONG);
    H5Pset_libver_bounds(access, H5F_LIBVER_V18, H5F_LIBVER_V18);   /* programs read it since 2008 */
    H5Pset_obj_track_times(how, 0);
    H5Pset_link_creation_order(how, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
    H5Pset_attr_creation_order(how, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
    hid_t id = H5Fcreate(path, H5F_ACC_TRUNC, how, access);
    H5Pclose(how);
    return id;
}

/* Open the file at the path.  HDF5 cannot go back and forth in a device or a FIFO: there it gets a file
 * without a name, which is copied at the end. */
static ss_status
open_disk(h5_output *out)
{
    struct stat st;
    out->spooled = stat(out->path, &st) == 0 && !S_ISREG(st.st_mode);
    FILE *spool = out->spooled ? tmpfile() : NULL;
    out->disk.fd = spool != NULL ? dup(fileno(spool))
        : out->spooled ? -1 : open(out->path, O_RDWR | O_CREAT | O_TRUNC, 0666);
    int why = errno;
    if (spool != NULL)
        fclose(spool);
    return out->disk.fd >= 0 ? SS_OK : ss_fail_errno(&out->error, out->path, why);
}

ss_status
ss_h5_output_open(h5_output *out)
{
    ss_status st = open_disk(out);
    if (st != SS_OK)
        return st;
    hid_t access = ss_h5_disk_access(&out->disk, &out->file.driver);
    if (access < 0)
        return SS_ENOMEM;
    out->file.id = create_file(out->path, access);
    H5Pclose(access);
    return out->file.id >= 0 ? SS_OK : SS_ENOMEM;
}

static int
copy_out(const h5_output *out)
{
    char piece[BUFSIZ];
    FILE *copy = fopen(out->path, "wb");
    off_t at = 0;
    ssize_t n = 1;
    if (copy == NULL)
        return errno;
    while (n > 0 && (n = pread(out->disk.fd, piece, sizeof piece, at)) > 0) {
        at += n;
        if (fwrite(piece, 1, (size_t)n, copy) != (size_t)n)
            n = -1;
    }
    int why = n < 0 ? errno : 0;
    return fclose(copy) != 0 && why == 0 ? errno : why;
}

/* Let HDF5 write its buffers and close the file. */
static ss_status
close_hdf5(h5_output *out, ss_status st)
{
    int good = out->file.id < 0 || H5Fclose(out->file.id) >= 0; /* and all objects in it */
    out->file.id = -1;
    return st == SS_OK && !good ? ss_h5_fail_write(&out->file, 0, "") : st;
}

ss_status
ss_h5_output_close(h5_output *out, ss_status st)
{
    struct stat is;
    st = close_hdf5(out, st);
    if (out->file.driver > 0)
        H5FDunregister(out->file.driver);
    out->file.driver = 0;
    if (out->disk.fd < 0)
        return st;
    if (st == SS_OK && out->disk.error == 0 && out->spooled)
        out->disk.error = copy_out(out);
    if (close(out->disk.fd) != 0 && out->disk.error == 0)
        out->disk.error = errno;
    out->disk.fd = -1;
    if (out->disk.error != 0)
        st = ss_fail_errno(&out->error, out->path, out->disk.error);
    if (st != SS_OK && !out->spooled && stat(out->path, &is) == 0 && S_ISREG(is.st_mode))
        unlink(out->path);
    return st;
}

ss_status
ss_h5_output_check(h5_output *out, ss_status st)
{
    if (st == SS_OK && out->disk.error != 0)
        st = ss_fail_errno(&out->error, out->path, out->disk.error);
    if (st == SS_ENOMEM)
        ss_fail(&out->error, st, "%s: %s", out->file.path, ss_strerror(st));
    return st;
}
