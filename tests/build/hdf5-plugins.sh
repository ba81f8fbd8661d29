# A file whose values are packed by a filter that only a plugin has makes no tool load one.
[ -z "$SAN" ] || { echo "sanitizers do not go into plugins"; exit 77; }
cat > write.c <<'C'
#include <hdf5.h>
#include <string.h>
static size_t copy(unsigned f, size_t n, const unsigned v[], size_t bytes, size_t *room, void **p)
{
    return f + n + (v == NULL) + *room + (*p == NULL) > 0 ? bytes : 0;
}
int main(void)
{
    static const H5Z_class2_t packing = { H5Z_CLASS_T_VERS, 32001, 1, 1, "copy", NULL, NULL, copy };
    const hsize_t n = 4;
    const double x[4] = { 1, 2, 3, 4 };
    hid_t file = H5Fcreate("run.h5", H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    hid_t space = H5Screate_simple(1, &n, NULL), how = H5Pcreate(H5P_DATASET_CREATE);
    H5Zregister(&packing);
    H5Pset_chunk(how, 1, &n);
    H5Pset_filter(how, 32001, H5Z_FLAG_MANDATORY, 0, NULL);
    hid_t id = H5Dcreate2(file, "x", H5T_IEEE_F64LE, space, H5P_DEFAULT, how, H5P_DEFAULT);
    H5Dwrite(id, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, x);
    H5Dclose(id);
    H5Pclose(how);
    H5Sclose(space);
    return H5Fclose(file) < 0;
}
C
cat > read.c <<'C'
#include <hdf5.h>
int main(void)
{
    double x[4];
    hid_t file = H5Fopen("run.h5", H5F_ACC_RDONLY, H5P_DEFAULT);
    hid_t id = H5Dopen2(file, "x", H5P_DEFAULT);
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
    H5Dread(id, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, x);
    return 0;
}
C
cat > plugin.c <<'C'
#include <stdio.h>
__attribute__((constructor)) static void load(void) { fclose(fopen("loaded", "w")); }
C
mkdir plugins
# shellcheck disable=SC2086  # flags are lists
{
$CCLD $INCLUDES -o write write.c $LIBS
$CCLD $INCLUDES -o read read.c $LIBS
$CCLD -shared -fPIC -o plugins/libcanary.so plugin.c || { echo "no shared libraries"; exit 77; }
}
./write
export HDF5_PLUGIN_PATH=plugins
./read
rm loaded || { echo "HDF5 here loads no plugins"; exit 77; }
ss-cat --rate 1 run.h5:/x 2>> refusals || [ ! -e loaded ] || echo "a plugin was loaded"
ss-cat run.h5 2>> refusals || [ ! -e loaded ] || echo "a plugin was loaded"
ss-contour run.h5 2>> refusals || [ ! -e loaded ] || echo "a plugin was loaded"
cat refusals
