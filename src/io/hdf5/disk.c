/* disk.c -- a driver of HDF5 whose writes never fail, and which reads no packed index.
 *
 * If HDF5 fails to write a file (a full disk), it cannot close it: it tries again at exit, fails
 * again, and prints messages.  So this driver reports no failure to HDF5.  It keeps the first
 * failure and writes nothing after it; the caller asks for the failure at the end.
 *
 * HDF5 packs more than values: the names in a group lie in a fractal heap, whose blocks may pass through
 * filters, and HDF5 unpacks them whole before it asks for one name.  Nothing bounds what they become, so a
 * file that is read fails at the head of such a heap, wherever it is. */
#include "io/hdf5/h5.h"

#include <errno.h>
#include <string.h>
#include <unistd.h>

static H5FD_t *
open_file(const char *name, unsigned flags, hid_t access, haddr_t most)
{
    (void)name, (void)flags, (void)most;
    h5_disk *disk = *(h5_disk *const *)H5Pget_driver_info(access);
    memset(&disk->of_hdf5, 0, sizeof disk->of_hdf5);
    disk->eoa = 0;
    disk->eof = disk->reading ? disk->eof : 0;
    return &disk->of_hdf5;
}

/* The disk stays the caller's. */
static herr_t
close_file(H5FD_t *file)
{
    (void)file;
    return 0;
}

static herr_t
query(const H5FD_t *file, unsigned long *flags)
{
    *flags = H5FD_FEAT_DATA_SIEVE;
    if (file == NULL || !((const h5_disk *)file)->reading)      /* what is accumulated is not read one by one */
        *flags |= H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA | H5FD_FEAT_AGGREGATE_SMALLDATA;
    return 0;
}

static haddr_t
get_eoa(const H5FD_t *file, H5FD_mem_t type)
{
    (void)type;
    return ((const h5_disk *)file)->eoa;
}

static herr_t
set_eoa(H5FD_t *file, H5FD_mem_t type, haddr_t end)
{
    (void)type;
    ((h5_disk *)file)->eoa = end;
    return 0;
}

static haddr_t
get_eof(const H5FD_t *file, H5FD_mem_t type)
{
    (void)type;
    return ((const h5_disk *)file)->eof;
}

/* Bytes that are not in the file read as zeros.  The head of a heap begins with FRHP, a version and the length of
 * an address, of 3 bytes, and the length of its filters.  An image of the cache, MDCI, would bring such heads
 * unseen. */
static herr_t
read_bytes(H5FD_t *file, H5FD_mem_t type, hid_t how, haddr_t at, size_t size, void *buffer)
{
    (void)how;
    size_t all = size;
    h5_disk *f = (h5_disk *)file;
    char *to = buffer, *is = buffer;
    while (size > 0) {
        ssize_t n = pread(f->fd, to, size, (off_t)at);
        if (n < 0 && errno == EINTR)
            continue;
        if (n < 0 && f->error == 0)
            f->error = errno;
        if (n <= 0)
            break;
        to += n;
        at += (haddr_t)n;
        size -= (size_t)n;
    }
    memset(to, 0, size);
    f->packed |= f->reading && type != H5FD_MEM_DRAW && all >= 9
        && ((memcmp(is, "FRHP", 4) == 0 && (is[7] | is[8]) != 0) || memcmp(is, "MDCI", 4) == 0);
    return f->packed ? -1 : 0;
}

static herr_t
write_bytes(H5FD_t *file, H5FD_mem_t type, hid_t how, haddr_t at, size_t size, const void *buffer)
{
    (void)type, (void)how;
    h5_disk *f = (h5_disk *)file;
    const char *from = buffer;
    f->eof = at + size > f->eof ? at + size : f->eof;
    while (size > 0 && f->error == 0) {
        ssize_t n = pwrite(f->fd, from, size, (off_t)at);
        if (n < 0 && errno != EINTR)
            f->error = errno;
        if (n <= 0)
            continue;
        from += n;
        at += (haddr_t)n;
        size -= (size_t)n;
    }
    return 0;
}

static herr_t
truncate_file(H5FD_t *file, hid_t how, hbool_t closing)
{
    (void)how, (void)closing;
    h5_disk *f = (h5_disk *)file;
    if (f->eof != f->eoa && f->error == 0 && ftruncate(f->fd, (off_t)f->eoa) != 0)
        f->error = errno;
    f->eof = f->eoa;
    return 0;
}

static const H5FD_class_t driver = {
#ifdef H5FD_CLASS_VERSION
    .version = H5FD_CLASS_VERSION,
    .value = H5_VFD_RESERVED + 100,     /* no published driver has this value */
#endif
    .name = "stickslip",
    .maxaddr = (haddr_t)1 << 62,
    .fc_degree = H5F_CLOSE_WEAK,
    .fapl_size = sizeof(h5_disk *),
    .open = open_file,
    .close = close_file,
    .query = query,
    .get_eoa = get_eoa,
    .set_eoa = set_eoa,
    .get_eof = get_eof,
    .read = read_bytes,
    .write = write_bytes,
    .truncate = truncate_file,
    .fl_map = H5FD_FLMAP_DICHOTOMY,
};

hid_t
ss_h5_disk_access(h5_disk *disk, hid_t *id)
{
    hid_t access = H5Pcreate(H5P_FILE_ACCESS);
    *id = H5FDregister(&driver);
    if (access >= 0 && *id >= 0 && H5Pset_driver(access, *id, &disk) >= 0)
        return access;
    H5Pclose(access);
    return -1;
}
