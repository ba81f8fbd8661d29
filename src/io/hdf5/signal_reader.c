/* signal_reader.c -- read the columns of /signal. */
#include <stdlib.h>
#include <string.h>
#include "base/list.h"
#include "signal/header.h"
#include "io/hdf5/groups.h"
#include "io/format.h"

/* The order of a group's links: that of writing if the file has it, else that of the names. */
static H5_index_t
link_order(hid_t group)
{
    unsigned tracked = 0;
    hid_t how = H5Gget_create_plist(group);
    H5Pget_link_creation_order(how, &tracked);
    H5Pclose(how);
    return tracked & H5P_CRT_ORDER_TRACKED ? H5_INDEX_CRT_ORDER : H5_INDEX_NAME;
}

struct links {
    char **name;
    size_t n, room;
    ss_status status;
};

static herr_t
append_link(hid_t group, const char *name, const H5L_info_t *info, void *user)
{
    struct links *links = user;
    char **more = ss_list_room(links->name, &links->room, links->n, sizeof *more);
    (void)group, (void)info;
    if (more != NULL)
        links->name = more;
    if (links->n == MAX_COLUMNS + 1)            /* 1 for t */
        links->status = SS_EDATA;
    else if (more == NULL || (more[links->n] = strdup(name)) == NULL)
        links->status = SS_ENOMEM;
    else
        links->n++;
    return links->status != SS_OK;
}

/* List all names of a group at once.  Asked one by one, HDF5 would sort them all again for each, if the
 * group has no index of that order.  Open one of them before: HDF5 1.10 frees pointers that it has not set
 * if it cannot read the heap of the names while it lists them. */
static ss_status
list_links(h5_file *file, hid_t group, struct links *links)
{
    if (H5Literate(group, link_order(group), H5_ITER_INC, NULL, append_link, links) < 0)
        return ss_h5_fail(file, SS_EIO, group, "", "cannot be read");
    if (links->status == SS_EDATA)
        return ss_h5_fail(file, SS_EDATA, group, "", "has more than 32768 columns");
    return links->status;
}

/* Open the dataset of n values at a link; it stays open. */
static ss_status
open_list(h5_file *file, hid_t group, const char *link, hid_t *id, size_t *n)
{
    ss_status status = ss_h5_read_size(file, group, link, n);
    if (status != SS_OK)
        return status;
    *id = ss_h5_open_pieces(group, link);
    hid_t space = H5Dget_space(*id);
    int rank = H5Sget_simple_extent_ndims(space);
    H5Sclose(space);
    return rank == 1 ? SS_OK : ss_h5_fail(file, SS_EDATA, group, link, "not a list of values");
}

/* Add the dataset at a link as a column of the header. */
static ss_status
add_column(signal_rows *s, hid_t group, const char *link, ss_header *head)
{
    size_t own;
    hid_t id;
    char *name = NULL, *unit = NULL;
    h5_file *file = &s->file;
    ss_status status = open_list(file, group, link, &id, &own);
    if (status != SS_OK)
        return status;
    s->dataset[s->n_datasets++] = id;
    if (own != s->n)
        return ss_h5_fail(file, SS_EDATA, group, link, "not as long as t");
    status = ss_h5_get_text(file, id, "column", &name);
    if (status == SS_OK)
        status = ss_h5_get_text(file, id, "units", &unit);
    if (status == SS_OK)
        status = ss_header_add_column(head, name != NULL && *name != '\0' ? name : link, unit, NULL);
    free(name);
    free(unit);
    return status;
}

static ss_status
add_columns(signal_rows *s, hid_t group, const struct links *links, ss_header *head)
{
    ss_status status = SS_OK;
    s->dataset = calloc(links->n + 1, sizeof *s->dataset);
    if (s->dataset == NULL)
        return SS_ENOMEM;
    for (size_t i = 0; status == SS_OK && i < links->n; i++)
        if (strcmp(links->name[i], "t") != 0)
            status = add_column(s, group, links->name[i], head);
    s->by_columns = s->n_datasets > 1;
    return status;
}

ss_status
ss_h5_find_signal(signal_rows *s, const ss_read_opts *opts)
{
    h5_file *file = &s->file;
    if (H5Lexists(file->id, "signal", H5P_DEFAULT) <= 0)
        return ss_h5_fail_listing(file);
    hid_t group = ss_h5_open_group(file->id, "/signal");
    struct links links = { .name = NULL };
    if (group < 0)
        return ss_h5_fail(file, SS_EDATA, 0, "/signal", "not a group of this file");
    ss_status status = ss_h5_read_header(file, group, &s->base.head);
    if (status == SS_OK)
        status = open_list(file, group, "t", &s->times, &s->n);
    if (status == SS_OK)
        status = list_links(file, group, &links);
    if (status == SS_OK)
        status = add_columns(s, group, &links, s->base.head);
    for (size_t i = 0; i < links.n; i++)
        free(links.name[i]);
    free(links.name);
    H5Gclose(group);
    return status == SS_OK ? ss_refuse_clock(file->path, s->base.head->rate, opts, file->err) : status;
}
