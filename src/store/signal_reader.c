/* signal_reader.c -- the samples of /signal, value by value as they were written. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/list.h"
#include "signal/header.h"
#include "store/groups.h"
#include "stream/clock.h"

/* The links of a group, in the order of writing where the file keeps it. */
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
    if (links->n == MAX_COLUMNS + 1)            /* and t */
        links->status = SS_EDATA;
    else if (more == NULL || (more[links->n] = strdup(name)) == NULL)
        links->status = SS_ENOMEM;
    else
        links->n++;
    return links->status != SS_OK;
}

/* All names of a group at once: one by one, HDF5 sorts them all again for each where the group has no
 * index of that order. */
static ss_status
list_links(h5_file *file, hid_t group, struct links *links)
{
    if (H5Literate(group, link_order(group), H5_ITER_INC, NULL, append_link, links) < 0)
        return ss_h5_fail(file, SS_EIO, group, "", "cannot be read");
    if (links->status == SS_EDATA)
        return ss_h5_fail(file, SS_EDATA, group, "", "has more than 32768 columns");
    return links->status;
}

/* Add the dataset at a link, of n values, as a column of the header. */
static ss_status
add_column(h5_file *file, hid_t group, const char *link, size_t n, ss_header *head)
{
    size_t own;
    char *name = NULL, *unit = NULL;
    ss_status status = ss_h5_read_size(file, group, link, &own);
    if (status != SS_OK)
        return status;
    if (own != n)
        return ss_h5_fail(file, SS_EDATA, group, link, "not as long as t");
    hid_t id = ss_h5_open_dataset(group, link);
    status = ss_h5_get_text(file, id, "column", &name);
    if (status == SS_OK)
        status = ss_h5_get_text(file, id, "units", &unit);
    if (status == SS_OK)
        status = ss_header_add_column(head, name != NULL && *name != '\0' ? name : link, unit);
    free(name);
    free(unit);
    H5Dclose(id);
    return status;
}

static ss_status
read_columns(h5_file *file, hid_t group, ss_header *head, const struct links *links,
             ss_signal **out)
{
    size_t n;
    ss_status status = ss_h5_read_size(file, group, "t", &n);
    for (size_t i = 0; status == SS_OK && i < links->n; i++)
        if (strcmp(links->name[i], "t") != 0)
            status = add_column(file, group, links->name[i], n, head);
    if (status == SS_OK)
        status = ss_signal_new(out, head, n);
    double *values = status == SS_OK ? (*out)->values : NULL;
    for (size_t i = 0; status == SS_OK && i < links->n; i++) {
        const char *name = links->name[i];
        if (strcmp(name, "t") == 0)
            continue;
        status = ss_h5_read_values(file, group, name, values, n);
        if (status == SS_OK)
            status = ss_h5_check_finite(file, group, name, values, n);
        values += n;
    }
    return status;
}

static ss_status
read_signal(h5_file *file, ss_signal **out)
{
    hid_t group = ss_h5_open_group(file->id, "/signal");
    struct links links = { .name = NULL };
    ss_header *head = NULL;
    if (group < 0)
        return ss_h5_fail(file, SS_EDATA, 0, "/signal", "not a group of this file");
    ss_status status = ss_h5_read_header(file, group, &head);
    if (status == SS_OK)
        status = list_links(file, group, &links);
    if (status == SS_OK)
        status = read_columns(file, group, head, &links, out);
    for (size_t i = 0; i < links.n; i++)
        free(links.name[i]);
    free(links.name);
    ss_header_free(head);
    H5Gclose(group);
    return status;
}

ss_status
ss_h5_read_signal(ss_signal **out, h5_file *file, const char *dataset, const ss_read_opts *opts)
{
    if (dataset != NULL && dataset[0] != '\0')
        return ss_h5_read_foreign(out, file, dataset, opts);
    if (H5Lexists(file->id, "signal", H5P_DEFAULT) <= 0)
        return ss_h5_fail_listing(file);
    ss_status status = read_signal(file, out);
    if (status != SS_OK || opts == NULL)
        return status;
    return ss_refuse_clock(file->path, (*out)->head->rate, opts, file->err);
}
